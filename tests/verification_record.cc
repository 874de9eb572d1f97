#include "verification_record.h"

#include <algorithm>
#include <boost/test/results_collector.hpp>
#include <boost/test/unit_test.hpp>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

namespace annulus::test {

namespace {

namespace fs = std::filesystem;
namespace bt = boost::unit_test;

/// Folder of a source file below tests/: the layer.
std::string layer_of(const std::string& source) {
  static const std::string tests = "/tests/";
  const auto begin = source.rfind(tests) + tests.size();
  return source.substr(begin, source.find('/', begin) - begin);
}

struct CaseName {
  std::string layer, suite, name;
};

CaseName running_case() {
  const auto& running = bt::framework::current_test_case();
  const auto& suite = bt::framework::get<bt::test_suite>(running.p_parent_id);
  const auto& file = running.p_file_name;
  return {layer_of({file.begin(), file.end()}), suite.p_name.get(), running.p_name.get()};
}

/// How a share of a tolerance of zero is told: all or nothing.
double share(double difference, double tolerance) {
  if (tolerance > 0) return difference / tolerance;
  return difference > 0 ? 2 : 0;
}

}  // namespace

Verification::Verification(std::string title, std::string reference)
    : title_(std::move(title)), reference_(std::move(reference)) {}

Verification::~Verification() {
  const char* folder = std::getenv("ANNULUS_VERIFICATION_RECORD");
  if (folder == nullptr || *folder == 0) return;
  const auto name = running_case();
  const fs::path file = fs::path(folder) / (name.layer + "." + name.suite + "." + name.name + ".json");
  std::error_code ignored;
  fs::create_directories(folder, ignored);
  if (bt::results_collector.results(bt::framework::current_test_case_id()).p_assertions_failed > 0 ||
      std::uncaught_exceptions() > 0)
    fs::remove(file, ignored);
  else
    std::ofstream(file) << text();
}

void Verification::close(const std::string& quantity, const std::string& unit, double computed, double expected,
                         double tolerance, const std::string& origin, const char* file, int line) {
  const double used =
      share(std::abs(computed - expected), tolerance * std::min(std::abs(computed), std::abs(expected)));
  add({quantity, unit, origin, Kind::relative, computed, expected, tolerance, used}, used <= 1, file, line);
}

void Verification::near(const std::string& quantity, const std::string& unit, double computed, double expected,
                        double tolerance, const std::string& origin, const char* file, int line) {
  const double used = share(std::abs(computed - expected), tolerance);
  add({quantity, unit, origin, Kind::absolute, computed, expected, tolerance, used}, used <= 1, file, line);
}

void Verification::at_most(const std::string& quantity, const std::string& unit, double computed, double bound,
                           const std::string& origin, const char* file, int line) {
  const double used = bound > 0 ? std::max(computed, 0.0) / bound : computed - bound;
  add({quantity, unit, origin, Kind::at_most, computed, 0, bound, used}, computed <= bound, file, line);
}

void Verification::at_least(const std::string& quantity, const std::string& unit, double computed, double bound,
                            const std::string& origin, const char* file, int line) {
  const double used = bound > 0 && computed > 0 ? bound / computed : bound - computed;
  add({quantity, unit, origin, Kind::at_least, computed, 0, bound, used}, computed >= bound, file, line);
}

void Verification::add(Row row, bool holds, const char* file, int line) {
  BOOST_CHECK_MESSAGE(holds, file << '(' << line << "): " << row.quantity << ": computed " << row.computed
                                  << (row.kind == Kind::at_most    ? ", at most "
                                      : row.kind == Kind::at_least ? ", at least "
                                                                   : ", expected ")
                                  << (row.kind < Kind::at_most ? row.expected : row.tolerance) << ' ' << row.unit
                                  << ", tolerance " << row.tolerance << ", used " << row.used << " of it");
  const auto same = [&](const Row& r) { return r.quantity == row.quantity && r.kind == row.kind; };
  const auto known = std::find_if(rows_.begin(), rows_.end(), same);
  if (known == rows_.end()) {
    row.comparisons = 1;
    rows_.push_back(std::move(row));
    return;
  }
  row.comparisons = known->comparisons + 1;
  if (row.used > known->used)
    *known = std::move(row);
  else
    known->comparisons = row.comparisons;
}

void Verification::plot(RecordedPlot plot) { plots_.push_back(std::move(plot)); }

void Verification::convergence(const std::string& title, const std::string& x_label, const std::string& y_label,
                               const std::string& label, const std::vector<double>& sizes,
                               const std::vector<double>& errors, double order) {
  RecordedPlot::Curve curve{label, sizes, errors, {}};
  const double finest = *std::min_element(sizes.begin(), sizes.end());
  const auto at = std::min_element(sizes.begin(), sizes.end()) - sizes.begin();
  for (const double size : sizes) curve.reference.push_back(errors[at] * std::pow(size / finest, order));
  const auto same = [&](const RecordedPlot& p) { return p.title == title; };
  auto known = std::find_if(plots_.begin(), plots_.end(), same);
  if (known == plots_.end()) known = plots_.insert(plots_.end(), {title, x_label, y_label, {}, true, true, true});
  known->curves.push_back(std::move(curve));
}

std::string Verification::text() const {
  using nlohmann::json;
  static const char* const kinds[] = {"relative", "absolute", "at_most", "at_least"};
  const auto name = running_case();
  json record = {{"layer", name.layer},     {"suite", name.suite},   {"case", name.name},     {"title", title_},
                 {"reference", reference_}, {"rows", json::array()}, {"plots", json::array()}};
  for (const auto& row : rows_)
    record["rows"].push_back({{"quantity", row.quantity},
                              {"unit", row.unit},
                              {"origin", row.origin},
                              {"kind", kinds[static_cast<int>(row.kind)]},
                              {"computed", row.computed},
                              {"expected", row.expected},
                              {"tolerance", row.tolerance},
                              {"used", row.used},
                              {"comparisons", row.comparisons}});
  for (const auto& plot : plots_) {
    json curves = json::array();
    for (const auto& c : plot.curves)
      curves.push_back({{"label", c.label},
                        {"x", c.x},
                        {"computed", c.computed},
                        {"reference", c.reference},
                        {"reference_x", c.reference_x}});
    record["plots"].push_back({{"title", plot.title},
                               {"x_label", plot.x_label},
                               {"y_label", plot.y_label},
                               {"x_log", plot.x_log},
                               {"y_log", plot.y_log},
                               {"slopes", plot.slopes},
                               {"curves", curves}});
  }
  return record.dump(1) + '\n';
}

}  // namespace annulus::test
