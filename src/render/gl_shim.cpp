// SPDX-License-Identifier: Apache-2.0
// Coin asks the process for glXGetProcAddress (dlsym) to fetch vertex arrays, buffers and textures.
// Debian's would answer with functions of a GL that has no context: silent no-ops, pictures with
// holes. These two answer for OSMesa instead. The link options in CMakeLists.txt keep and export
// them in every program.
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
