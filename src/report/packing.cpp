// SPDX-License-Identifier: Apache-2.0
#include "report/packing.h"

#include <zlib.h>

#include <limits>

#include "core/base64.h"
#include "core/error.h"

namespace navvy::report {

std::string packed_bytes(std::span<const std::byte> bytes) {
  if (bytes.empty()) return "";
  constexpr int kGzip = 16;  // added to the size of the window: gzip's header and check sum
  z_stream stream{};
  if (bytes.size() > std::numeric_limits<uInt>::max() ||
      deflateInit2(&stream, Z_DEFAULT_COMPRESSION, Z_DEFLATED, MAX_WBITS + kGzip, 8,
                   Z_DEFAULT_STRATEGY) != Z_OK)
    throw Error("the data of a page cannot be compressed");
  std::vector<std::byte> out(deflateBound(&stream, static_cast<uLong>(bytes.size())));
  // zlib does not write to its input.
  stream.next_in = reinterpret_cast<Bytef*>(const_cast<std::byte*>(bytes.data()));
  stream.avail_in = static_cast<uInt>(bytes.size());
  stream.next_out = reinterpret_cast<Bytef*>(out.data());
  stream.avail_out = static_cast<uInt>(out.size());
  const int end = deflate(&stream, Z_FINISH);
  out.resize(stream.total_out);
  deflateEnd(&stream);
  if (end != Z_STREAM_END) throw Error("the data of a page cannot be compressed");
  return base64(out);
}

}  // namespace navvy::report
