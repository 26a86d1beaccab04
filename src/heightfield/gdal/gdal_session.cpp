// SPDX-License-Identifier: Apache-2.0
// GDAL prints to stderr by default; our libraries must not.
#include "heightfield/gdal/gdal_session.h"

#include <cpl_error.h>
#include <gdal.h>

#include <mutex>

namespace navvy::heightfield {
namespace {

// Size of the cache of decoded blocks. By default it is a twentieth of the memory of the machine,
// but the cost of a map, and whether it is refused, must not depend on that.
constexpr GIntBig kCacheBytes = GIntBig{512} << 20;

void CPL_STDCALL collect(CPLErr severity, CPLErrorNum /*number*/, const char* message) {
  // Warnings concern files that were read all the same.
  if (severity >= CE_Failure) static_cast<GdalSession*>(CPLGetErrorHandlerUserData())->add(message);
}

}  // namespace

// The handler is pushed per thread: several sessions may live at a time.
GdalSession::GdalSession() {
  CPLPushErrorHandlerEx(collect, this);
  // Drivers are registered once per process and never removed.
  static std::once_flag once;
  std::call_once(once, [] {
    GDALAllRegister();
    GDALSetCacheMax64(kCacheBytes);
  });
}

GdalSession::~GdalSession() {
  CPLPopErrorHandler();
  CPLErrorReset();
}

}  // namespace navvy::heightfield
