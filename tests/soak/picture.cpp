// SPDX-License-Identifier: Apache-2.0
// bytes.svg: three strips, one per kind of bytes, over simulated hours.
#include <algorithm>
#include <cstdio>

#include "soak/soak.h"

namespace navvy::soak {
namespace {

constexpr double kWide = 900, kHigh = 170, kLeft = 90, kTop = 30;  // size of a strip [px]

struct Kind {
  const char* name;
  std::int64_t Bytes::*bytes;
  const char* color;
};
constexpr Kind kKinds[] = {{"allocated by malloc", &Bytes::heap, "#1f6feb"},
                           {"resident", &Bytes::resident, "#8250df"},
                           {"buffers of the device", &Bytes::device, "#bf8700"}};

std::string text_at(double x, double y, const char* anchor, const std::string& text) {
  char head[96];
  std::snprintf(head, sizeof head, "<text x=\"%.1f\" y=\"%.1f\" text-anchor=\"%s\">", x, y, anchor);
  return head + text + "</text>\n";
}

std::string mib(double bytes) {
  char text[32];
  std::snprintf(text, sizeof text, "%.3f MiB", bytes / 1048576);
  return text;
}

/// Draws a strip with its top at `top`. The axis starts at zero, so that growth can be
/// distinguished from noise.
std::string strip(const std::vector<Phase>& phases, const Kind& kind, double top, double hours) {
  double most = 1;
  for (const Phase& p : phases) most = std::max(most, static_cast<double>(p.bytes.*kind.bytes));
  const double bottom = top + kHigh - kTop;
  std::string points;
  char text[256];
  for (const Phase& p : phases) {
    std::snprintf(text, sizeof text, "%.1f,%.1f ", kLeft + kWide * p.time / 3600 / hours,
                  bottom - (bottom - top) * static_cast<double>(p.bytes.*kind.bytes) / most);
    points += text;
  }
  std::snprintf(text, sizeof text,
                "<path d=\"M%.0f %.0fV%.0fH%.0f\" stroke=\"#888\" fill=\"none\"/>\n", kLeft, top,
                bottom, kLeft + kWide);
  return text + text_at(kLeft, top - 6, "start", kind.name) +
         text_at(kLeft - 6, top + 5, "end", mib(most)) + text_at(kLeft - 6, bottom, "end", "0") +
         "<polyline fill=\"none\" stroke-width=\"1.5\" stroke=\"" + kind.color + "\" points=\"" +
         points + "\"/>\n";
}

}  // namespace

std::string picture(const std::vector<Phase>& phases) {
  const double hours = phases.empty() ? 1 : std::max(phases.back().time / 3600, 1e-6);
  char text[256];
  std::snprintf(text, sizeof text,
                "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 %.0f %.0f\" "
                "font-family=\"sans-serif\" "
                "font-size=\"12\">\n<rect width=\"100%%\" height=\"100%%\" fill=\"white\"/>\n",
                kLeft + kWide + 30, 3 * kHigh + 2 * kTop);
  std::string out = text;
  double top = kTop;
  for (const Kind& kind : kKinds) {
    out += strip(phases, kind, top, hours);
    top += kHigh;
  }
  // No growth is allowed after the first quarter.
  const double quarter = kLeft + kWide / 4;
  std::snprintf(text, sizeof text,
                "<path d=\"M%.1f %.0fV%.0f\" stroke=\"#888\" stroke-dasharray=\"4 4\"/>\n", quarter,
                kTop, top - kTop);
  out += text + text_at(quarter + 4, top - kTop - 4, "start", "first quarter");
  std::snprintf(text, sizeof text, "%.3f h simulated", hours);
  return out + text_at(kLeft, top - 10, "start", "0") +
         text_at(kLeft + kWide, top - 10, "end", text) + "</svg>\n";
}

}  // namespace navvy::soak
