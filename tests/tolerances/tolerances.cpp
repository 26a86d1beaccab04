// SPDX-License-Identifier: Apache-2.0
#include "tolerances/tolerances.h"
#include "paths.h"

#include <cmath>
#include <cstdio>
#include <fstream>
#include <limits>
#include <set>
#include <sstream>
#include <stdexcept>

namespace navvy::tolerances {
namespace {

constexpr double kOpen = std::numeric_limits<double>::infinity();
constexpr const char* kTable = "tests/tolerances/known_deviations.md";

std::string trimmed(const std::string& text) {
  const std::size_t first = text.find_first_not_of(' ');
  return first == std::string::npos ? ""
                                    : text.substr(first, text.find_last_not_of(' ') - first + 1);
}

/// Returns the cells of a Markdown row, without the bars at its ends.
std::vector<std::string> cells_of(const std::string& line) {
  std::vector<std::string> out;
  std::size_t from = 1;
  for (std::size_t bar = line.find('|', from); bar != std::string::npos;
       bar = line.find('|', from)) {
    out.push_back(trimmed(line.substr(from, bar - from)));
    from = bar + 1;
  }
  return out;
}

double number(const std::string& text, double if_empty) {
  if (text.empty()) return if_empty;
  std::size_t used = 0;
  const double value = std::stod(text, &used);
  if (used != text.size()) throw std::invalid_argument(text);
  return value;
}

/// Parses "0.1 .. 0.2", ".. 0.2", "0.1 ..".
Band band_of(const std::string& text) {
  const std::size_t dots = text.find("..");
  if (dots == std::string::npos) throw std::invalid_argument(text);
  const Band out = {number(trimmed(text.substr(0, dots)), -kOpen),
                    number(trimmed(text.substr(dots + 2)), kOpen)};
  if (!(out.low <= out.high)) throw std::invalid_argument(text);
  return out;
}

/// Compares bounds, which the table gives with a few digits.
bool same(double a, double b) {
  return a == b || std::abs(a - b) <= 1e-3 * std::max(std::abs(a), std::abs(b));
}

/// The table of this tree, and the rows that were measured.
struct Table {
  std::vector<KnownDeviation> rows;
  std::set<const KnownDeviation*> seen;

  const KnownDeviation* find(const std::string& test, const std::string& quantity) {
    for (const KnownDeviation& row : rows)
      if (row.test == test && row.quantity == quantity) {
        seen.insert(&row);
        return &row;
      }
    return nullptr;
  }
};

Table& table() {
  static Table shared = [] {
    std::ifstream file(navvy::source_dir() + "/" + kTable);
    std::stringstream text;
    text << file.rdbuf();
    return Table{parse_known_deviations(text.str()), {}};
  }();
  return shared;
}

std::string name_of(const testing::TestInfo& test) {
  return std::string(test.test_suite_name()) + "." + test.name();
}

/// Fails a test that ran to its end without measuring every row it has in the table.
class EveryRowIsMeasured : public testing::EmptyTestEventListener {
  void OnTestEnd(const testing::TestInfo& test) override {
    if (test.result()->Skipped() || test.result()->HasFatalFailure()) return;
    for (const KnownDeviation& row : table().rows)
      if (row.test == name_of(test) && table().seen.count(&row) == 0)
        ADD_FAILURE() << kTable << " has a row for '" << row.quantity << "', which " << row.test
                      << " does not measure: correct its name or remove it";
  }
};

const bool kListens = [] {
  testing::UnitTest::GetInstance()->listeners().Append(new EveryRowIsMeasured);
  return true;
}();

const char* mark(Verdict verdict) {
  switch (verdict) {
    case Verdict::kMet:
      return "ok";
    case Verdict::kKnownDeviation:
    case Verdict::kBetterDeviation:
      return "known deviation";
    case Verdict::kOutOfTolerance:
    case Verdict::kWorse:
      return "outside";
    case Verdict::kNewlyMet:
      return "ok, table old";
    case Verdict::kToleranceMoved:
      return "TOLERANCE MOVED";
  }
  return "";
}

}  // namespace

std::vector<KnownDeviation> parse_known_deviations(const std::string& text) {
  std::vector<KnownDeviation> out;
  std::istringstream lines(text);
  std::string line;
  for (int number = 1, in_table = 0; std::getline(lines, line); ++number) {
    if (line.empty() || line.front() != '|') in_table = 0;
    // The first two lines of a table are its head.
    if (line.empty() || line.front() != '|' || ++in_table <= 2) continue;
    const auto refuse = [&](const std::string& why) {
      throw std::runtime_error(std::string(kTable) + ":" + std::to_string(number) + ": " + why);
    };
    const std::vector<std::string> cells = cells_of(line);
    if (cells.size() != 5) refuse("a row has five cells: test, quantity, now, tolerance, cause");
    KnownDeviation row = {cells[0], cells[1], {}, {}, cells[4]};
    try {
      row.now = band_of(cells[2]), row.tolerance = band_of(cells[3]);
    } catch (const std::exception&) {
      refuse(
          "'now' and 'tolerance' are written '0.1 .. 0.2'; a side of the tolerance may be empty");
    }
    if (row.reason.empty()) refuse("the cause is missing");
    if (row.now.low <= row.tolerance.high && row.now.high >= row.tolerance.low)
      refuse("'now' overlaps the tolerance");
    for (const KnownDeviation& other : out)
      if (other.test == row.test && other.quantity == row.quantity)
        refuse("this quantity occurs twice");
    out.push_back(row);
  }
  return out;
}

Verdict judge(const KnownDeviation* known, double measured, const Band& tolerance) {
  if (known == nullptr) return tolerance.holds(measured) ? Verdict::kMet : Verdict::kOutOfTolerance;
  if (!same(known->tolerance.low, tolerance.low) || !same(known->tolerance.high, tolerance.high))
    return Verdict::kToleranceMoved;
  if (tolerance.holds(measured)) return Verdict::kNewlyMet;
  if (known->now.holds(measured)) return Verdict::kKnownDeviation;
  const bool between = known->now.high < tolerance.low
                           ? measured > known->now.high && measured < tolerance.low
                           : measured < known->now.low && measured > tolerance.high;
  return between ? Verdict::kBetterDeviation : Verdict::kWorse;
}

void expect_between(const std::string& quantity, double measured, double low, double high,
                    const std::string& source, double expected) {
  const testing::TestInfo* running = testing::UnitTest::GetInstance()->current_test_info();
  const KnownDeviation* known =
      running == nullptr ? nullptr : table().find(name_of(*running), quantity);
  const Verdict verdict = judge(known, measured, {low, high});
  char wanted[32] = "";
  if (!std::isnan(expected)) std::snprintf(wanted, sizeof wanted, "%.5g", expected);
  std::printf("| %-44s | %12.5g | %8s | %10.5g .. %-10.5g | %-10s | %s |\n", quantity.c_str(),
              measured, wanted, low, high, mark(verdict), source.c_str());
  switch (verdict) {
    case Verdict::kMet:
      break;
    case Verdict::kOutOfTolerance:
      ADD_FAILURE() << quantity << ": " << measured << " is outside " << low << " .. " << high;
      break;
    case Verdict::kKnownDeviation:
    case Verdict::kBetterDeviation:
      // ./dev validate collects these lines.
      std::printf("[KNOWN DEVIATION] %s: %s = %.5g, tolerance %.5g .. %.5g: %s%s\n",
                  known->test.c_str(), quantity.c_str(), measured, low, high, known->reason.c_str(),
                  verdict == Verdict::kBetterDeviation
                      ? " (better than in the table: narrow its row)"
                      : "");
      break;
    case Verdict::kWorse:
      ADD_FAILURE() << quantity << ": " << measured << " is outside " << low << " .. " << high
                    << " by more than in " << kTable << " (" << known->now.low << " .. "
                    << known->now.high
                    << "): correct the cause; if the change is wanted, write the new range into "
                       "the table with its cause";
      break;
    case Verdict::kNewlyMet:
      ADD_FAILURE() << quantity << ": " << measured
                    << " now meets its tolerance: remove its row from " << kTable
                    << " and the deviation from tests/README.md";
      break;
    case Verdict::kToleranceMoved:
      ADD_FAILURE() << quantity << ": the test's tolerance " << low << " .. " << high
                    << " is not that of " << kTable << ", " << known->tolerance.low << " .. "
                    << known->tolerance.high << ": a tolerance keeps the value of its source";
      break;
  }
}

}  // namespace navvy::tolerances
