// SPDX-License-Identifier: Apache-2.0
#include "heightfield/gdal/session.h"

#include <cpl_error.h>
#include <gdal.h>

#include <mutex>

namespace navvy::heightfield {
namespace {

void CPL_STDCALL collect(CPLErr severity, CPLErrorNum /*number*/, const char* message) {
  if (severity >= CE_Failure) static_cast<GdalSession*>(CPLGetErrorHandlerUserData())->add(message);
}

}  // namespace

GdalSession::GdalSession() {
  CPLPushErrorHandlerEx(collect, this);
  static std::once_flag once;
  std::call_once(once, GDALAllRegister);
}

GdalSession::~GdalSession() {
  CPLPopErrorHandler();
  CPLErrorReset();
}

}  // namespace navvy::heightfield
