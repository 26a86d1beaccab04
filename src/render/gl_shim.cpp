// SPDX-License-Identifier: Apache-2.0
// Coin looks up glXGetProcAddress in the process (dlsym) to get functions for vertex arrays,
// buffers and textures. Debian's function would return those of a GL without a context: silent
// no-ops and pictures with holes. The two functions here return OSMesa's instead. The link options
// in CMakeLists.txt keep and export them in every program.
#include <GL/osmesa.h>

#include <cstring>

using Function = void (*)();

extern "C" {

__attribute__((visibility("default"), used)) Function glXGetProcAddress(const unsigned char* name) {
  const char* text = reinterpret_cast<const char*>(name);
  if (OSMesaGetCurrentContext() == nullptr || std::strncmp(text, "glX", 3) == 0) return nullptr;
  return OSMesaGetProcAddress(text);
}

__attribute__((visibility("default"), used)) void* glXGetCurrentContext() {
  return OSMesaGetCurrentContext();
}

}  // extern "C"
