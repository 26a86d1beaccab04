// SPDX-License-Identifier: Apache-2.0
#include "lab/svg_plot.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <limits>
#include <set>

#include "lab/parameter.h"

namespace navvy::lab {
namespace {

// Frame inside the picture; the legend is to its right.
constexpr double kWidth = 760, kHeight = 480, kLeft = 80, kRight = 540, kTop = 46, kBottom = 420;

/// Colours that remain distinct with red-green deficiency.
/// These are colours of the palette of Okabe and Ito, without its yellow, which is faint on white,
/// and with a grey.
constexpr std::array<const char*, 8> kColours = {"#0072b2", "#d55e00", "#009e73", "#cc79a7",
                                                 "#56b4e9", "#e69f00", "#000000", "#7f7f7f"};

/// Axis of the values `low` to `high`, drawn from `from` to `to`.
struct Axis {
  double low = 0, high = 1, from = 0, to = 1;
  bool logarithmic = false;

  double at(double value) const {
    const auto scale = [this](double v) { return logarithmic ? std::log(v) : v; };
    return from + (to - from) * (scale(value) - scale(low)) / (scale(high) - scale(low));
  }
};

std::string escaped(const std::string& text) {
  std::string out;
  // Texts are only put between tags, where quotes need no escape.
  for (const char c : text)
    out += c == '&' ? "&amp;" : c == '<' ? "&lt;" : c == '>' ? "&gt;" : std::string(1, c);
  return out;
}

/// A tenth of a unit is finer than visible.
std::string at(double value) {
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%.1f", value);
  return text.data();
}

std::string line(double x1, double y1, double x2, double y2, const std::string& style) {
  return "<line x1=\"" + at(x1) + "\" y1=\"" + at(y1) + "\" x2=\"" + at(x2) + "\" y2=\"" + at(y2) +
         "\" " + style + "/>\n";
}

std::string text(double x, double y, const std::string& anchor, const std::string& words,
                 const std::string& more = "") {
  return "<text x=\"" + at(x) + "\" y=\"" + at(y) + "\" text-anchor=\"" + anchor + "\"" + more +
         ">" + escaped(words) + "</text>\n";
}

bool drawn(const PlotLine& l, std::size_t i) {
  return std::isfinite(l.x[i]) && std::isfinite(l.y[i]);
}

/// Returns all abscissae once, in order.
std::set<double> abscissae(const Plot& plot) {
  std::set<double> out;
  for (const PlotLine& l : plot.lines)
    for (std::size_t i = 0; i < l.x.size(); ++i)
      if (drawn(l, i)) out.insert(l.x[i]);
  return out;
}

Axis x_axis(const std::set<double>& values) {
  // Markers of the outermost values stay 20 pixels inside the frame.
  Axis out{0, 1, kLeft + 20, kRight - 20, false};
  if (values.empty()) return out;
  out.low = *values.begin(), out.high = *values.rbegin();
  out.logarithmic = out.low > 0 && out.high > 5 * out.low;
  // A single value is drawn in the middle.
  if (!(out.high > out.low)) out.low -= 1, out.high += 1;
  return out;
}

Axis y_axis(const Plot& plot) {
  double low = std::numeric_limits<double>::infinity(), high = -low;
  const auto take = [&](double v) {
    if (std::isfinite(v)) low = std::min(low, v), high = std::max(high, v);
  };
  for (const PlotLine& l : plot.lines)
    for (const double v : l.y) take(v);
  for (const double v : plot.expected) take(v);
  for (const auto& [from, to] : plot.tolerances) take(from), take(to);
  if (!(low <= high)) low = 0, high = 1;
  // The axis starts at zero unless the values are far from it.
  if (low > 0 && low < 0.4 * high) low = 0;
  // 8 % of the range above and below; for a single value a tenth of it.
  const double margin = high > low ? 0.08 * (high - low) : std::max(1e-9, 0.1 * std::abs(high));
  return {low == 0 ? 0 : low - margin, high + margin, kBottom, kTop, false};
}

/// One marker shape per line, so that a grey print is readable, too.
std::string mark(double x, double y, std::size_t index, const std::string& fill) {
  if (index % 2 == 0)
    return "<circle cx=\"" + at(x) + "\" cy=\"" + at(y) + "\" r=\"4\" " + fill + "/>\n";
  return "<rect x=\"" + at(x - 4) + "\" y=\"" + at(y - 4) + "\" width=\"8\" height=\"8\" " + fill +
         "/>\n";
}

std::string frame(const Plot& plot, const Axis& x, const Axis& y, const std::set<double>& values) {
  std::string out;
  for (const double tick : round_ticks(y.low, y.high, 6)) {
    out += line(kLeft, y.at(tick), kRight, y.at(tick), "stroke=\"#dddddd\"");
    out += text(kLeft - 8, y.at(tick) + 4, "end", short_text(tick));
  }
  // Few values label the axis themselves.
  const bool few = values.size() <= 8;
  const std::vector<double> ticks =
      few ? std::vector<double>(values.begin(), values.end()) : round_ticks(x.low, x.high, 6);
  for (const double tick : ticks) {
    out += line(x.at(tick), kBottom, x.at(tick), kBottom + 5, "stroke=\"black\"");
    out += text(x.at(tick), kBottom + 20, "middle", short_text(tick));
  }
  out += "<rect x=\"" + at(kLeft) + "\" y=\"" + at(kTop) + "\" width=\"" + at(kRight - kLeft) +
         "\" height=\"" + at(kBottom - kTop) + "\" fill=\"none\" stroke=\"black\"/>\n";
  out += text((kLeft + kRight) / 2, kBottom + 44, "middle",
              plot.x_label + (x.logarithmic ? ", logarithmic" : ""));
  out += text(0, 0, "middle", plot.y_label,
              " transform=\"translate(20 " + at((kTop + kBottom) / 2) + ") rotate(-90)\"");
  return out + text(kLeft, 26, "start", plot.title, " font-size=\"16\"");
}

}  // namespace

std::vector<double> round_ticks(double low, double high, int count) {
  if (!(high > low) || count < 1) return {low};
  const double rough = (high - low) / count, power = std::pow(10, std::floor(std::log10(rough)));
  const double step = power * (rough > 5 * power   ? 10
                               : rough > 2 * power ? 5
                               : rough > power     ? 2
                                                   : 1);
  std::vector<double> out;
  // In whole numbers of steps: a sum would drift and miss zero.
  for (double i = std::ceil(low / step - 1e-9); i * step <= high + 1e-9 * step; i += 1)
    // Avoids -0.
    out.push_back(i == 0 ? 0 : i * step);
  return out;
}

std::string svg_of(const Plot& plot) {
  const std::set<double> values = abscissae(plot);
  const Axis x = x_axis(values), y = y_axis(plot);
  std::string out = "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"" + at(kWidth) +
                    "\" height=\"" + at(kHeight) +
                    "\" viewBox=\"0 0 760 480\" font-family=\"sans-serif\" font-size=\"13\">\n" +
                    "<rect width=\"760\" height=\"480\" fill=\"white\"/>\n";
  // SVG draws in order: bands first, then the frame with its grid, and lines above both.
  for (const auto& [low, high] : plot.tolerances)
    out += "<rect x=\"" + at(kLeft) + "\" y=\"" + at(y.at(high)) + "\" width=\"" +
           at(kRight - kLeft) + "\" height=\"" + at(y.at(low) - y.at(high)) +
           "\" fill=\"#eeeeee\"/>\n";
  out += frame(plot, x, y, values);
  for (const double height : plot.expected)
    out += line(kLeft, y.at(height), kRight, y.at(height),
                "stroke=\"#555555\" stroke-dasharray=\"6 4\"");
  for (std::size_t k = 0; k < plot.lines.size(); ++k) {
    const PlotLine& l = plot.lines[k];
    const std::string colour = kColours[k % kColours.size()];
    std::string points, marks;
    for (std::size_t i = 0; i < l.x.size(); ++i) {
      if (!drawn(l, i)) continue;
      points += (points.empty() ? "" : " ") + at(x.at(l.x[i])) + "," + at(y.at(l.y[i]));
      marks += mark(x.at(l.x[i]), y.at(l.y[i]), k, "fill=\"" + colour + "\"");
    }
    out += "<polyline points=\"" + points + "\" fill=\"none\" stroke=\"" + colour +
           "\" stroke-width=\"2\"/>\n" + marks;
    const double row = kTop + 14 + 20 * static_cast<double>(k);
    out += mark(kRight + 18, row - 4, k, "fill=\"" + colour + "\"") +
           text(kRight + 30, row, "start", l.name);
  }
  return out + "</svg>\n";
}

}  // namespace navvy::lab
