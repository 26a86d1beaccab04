// SPDX-License-Identifier: Apache-2.0
// The HTTP server of builds without cpp-httplib: it says what is missing.
#include "core/error.h"
#include "link/http/http_server.h"

#ifndef NAVVY_WITH_VIEW

namespace navvy::link {

struct HttpServer::State {};

void HttpServer::require_built(const std::string& option) {
  throw InputError(Fault{Fault::Severity::kError, "", 0, option, "",
                         "this Navvy was built without the library cpp-httplib, which serves pages",
                         "install libcpp-httplib-dev and build with -DNAVVY_WITH_VIEW=ON"});
}

HttpServer::HttpServer(const std::string& option, int, int,
                       std::vector<std::pair<std::string, std::string>>, Handler) {
  require_built(option);
}
HttpServer::~HttpServer() = default;
void HttpServer::close() {}
int HttpServer::port() const { return 0; }

}  // namespace navvy::link

#endif
