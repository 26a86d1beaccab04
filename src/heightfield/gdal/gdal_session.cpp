// SPDX-License-Identifier: Apache-2.0
// GDAL talks to stderr unless told otherwise; a library of ours may not.
#include "heightfield/gdal/gdal_session.h"

#include <cpl_error.h>
#include <gdal.h>

#include <mutex>

namespace navvy::heightfield {
namespace {

// Decoded blocks that wait side by side. By default a twentieth of the machine's memory: what a map
// costs, and whether it is refused, must not depend on that.
constexpr GIntBig kCacheBytes = GIntBig{512} << 20;

void CPL_STDCALL collect(CPLErr severity, CPLErrorNum /*number*/, const char* message) {
  // Warnings are about files that were read all the same.
  if (severity >= CE_Failure) static_cast<GdalSession*>(CPLGetErrorHandlerUserData())->add(message);
}

}  // namespace

GdalSession::GdalSession() {
  CPLPushErrorHandlerEx(collect, this);
  // Drivers are registered once a process and never taken back.
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
