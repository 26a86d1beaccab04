// SPDX-License-Identifier: Apache-2.0
// GDAL prints to stderr by default; our libraries must not.
#include "heightfield/gdal/gdal_session.h"

#include <cpl_error.h>
#include <gdal.h>

#include <mutex>

#include "heightfield/map_files/raster_source.h"

namespace navvy::heightfield {
namespace {

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
    GDALSetCacheMax64(kBlockCacheBytes);
  });
}

GdalSession::~GdalSession() {
  CPLPopErrorHandler();
  CPLErrorReset();
}

}  // namespace navvy::heightfield
