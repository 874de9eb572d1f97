#include "core/stiffness_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <boost/math/interpolators/makima.hpp>
#include <cmath>
#include <numeric>

#include "core/csv.h"
#include "core/errors.h"
#include "core/floating_point.h"
#include "core/units.h"

namespace annulus {

namespace {

const std::vector<std::string> table_columns = {"mesh_phase",
                                                "ring_angle_deg",
                                                "load_N",
                                                "unloaded_te_m",
                                                "lte_m",
                                                "stiffness_secant_N_per_m",
                                                "stiffness_tangent_N_per_m",
                                                "error_relative"};

/// The column of a part of the error: "error_discretisation_relative". Tables from elsewhere may go without.
std::string part_column(const char* part) { return fmt::format("error_{}_relative", part); }

/// What is wrong with an entry, empty if nothing is.
std::string complaint(const StiffnessEntry& e, double load) {
  // Far from what overflows in the arithmetic of curves.
  constexpr double largest = 1e30;
  for (const double value : {e.unloaded_te, e.lte, e.stiffness_secant, e.stiffness_tangent, e.error_relative})
    if (!(std::abs(value) <= largest)) return "a value is not finite, or beyond any unit";
  if (e.stiffness_secant <= 0 || e.stiffness_tangent <= 0) return "a stiffness is not positive";
  if (e.error_relative < 0) return "error_relative is negative";
  for (const auto& [name, part] : stiffness_error_part_names)
    if (!(e.error_parts.*part >= 0)) return part_column(name) + " is not a number from zero on";
  // Catches exchanged columns and wrong units; loose enough for a table rounded to a few digits by hand.
  const double force = e.stiffness_secant * (e.lte - e.unloaded_te);
  if (std::abs(force - load) > 1e-3 * load)
    return fmt::format("stiffness_secant x (lte - unloaded_te) = {:g} N is not the load {:g} N", force, load);
  return {};
}

std::size_t index_of(std::size_t position, std::size_t phase, std::size_t load, std::size_t phases, std::size_t loads) {
  return (position * phases + phase) * loads + load;
}

}  // namespace

StiffnessTable::StiffnessTable(std::string mesh, int phases, std::vector<double> ring_angles, std::vector<double> loads,
                               std::vector<StiffnessEntry> entries)
    : mesh_(std::move(mesh)),
      phases_(phases),
      ring_angles_(std::move(ring_angles)),
      loads_(std::move(loads)),
      entries_(std::move(entries)) {
  const auto refuse = [&](const std::string& what) { throw InputError("stiffness table " + mesh_ + ": " + what); };
  if (mesh_.empty()) refuse("its mesh has no name");
  if (phases_ < 1 || ring_angles_.empty() || loads_.empty()) refuse("it needs a phase, a ring position and a load");
  const auto expected = static_cast<std::size_t>(phases_) * ring_angles_.size() * loads_.size();
  if (entries_.size() != expected)
    refuse(fmt::format("{} entries where {} phases x {} positions x {} loads need {}", entries_.size(), phases_,
                       ring_angles_.size(), loads_.size(), expected));
  for (const double angle : ring_angles_)
    if (!std::isfinite(angle)) refuse("a ring angle is not finite");
  for (std::size_t i = 0; i < loads_.size(); ++i)
    if (!(loads_[i] <= 1e30) || loads_[i] <= (i ? loads_[i - 1] : 0.0))
      refuse("loads must be positive and strictly increasing");
  for (std::size_t i = 0; i < entries_.size(); ++i) {
    const auto what = complaint(entries_[i], loads_[i % loads_.size()]);
    if (!what.empty()) refuse(fmt::format("entry {}: {}", i, what));
  }
}

const StiffnessEntry& StiffnessTable::at(int position, int phase, int load) const {
  require(position >= 0 && position < positions() && phase >= 0 && phase < phases_ && load >= 0 &&
              load < static_cast<int>(loads_.size()),
          "stiffness table index out of range");
  return entries_[index_of(position, phase, load, phases_, loads_.size())];
}

void StiffnessTable::write_csv(const std::filesystem::path& file) const {
  Csv csv;
  csv.header.emplace_back("mesh", mesh_);
  csv.header.emplace_back("rows", std::to_string(entries_.size()));
  csv.header.insert(csv.header.end(), provenance.begin(), provenance.end());
  csv.columns = table_columns;
  for (const auto& [name, part] : stiffness_error_part_names) csv.columns.push_back(part_column(name));
  for (int position = 0; position < positions(); ++position)
    for (int phase = 0; phase < phases_; ++phase)
      for (std::size_t load = 0; load < loads_.size(); ++load) {
        const auto& e = at(position, phase, static_cast<int>(load));
        csv.rows.push_back({static_cast<double>(phase) / phases_, ring_angles_[position] / units::deg, loads_[load],
                            e.unloaded_te, e.lte, e.stiffness_secant, e.stiffness_tangent, e.error_relative});
        for (const auto& [name, part] : stiffness_error_part_names) csv.rows.back().push_back(e.error_parts.*part);
      }
  csv.write(file);
}

StiffnessTable StiffnessTable::read_csv(const std::filesystem::path& file) {
  const Csv csv = Csv::read(file);
  std::vector<std::size_t> column;
  for (const auto& name : table_columns) {
    if (std::find(csv.columns.begin(), csv.columns.end(), name) == csv.columns.end())
      throw csv.at_columns(
          fmt::format("is not a stiffness table: no column '{}'; there are: {}", name, csv.column_names()));
    column.push_back(csv.column(name));
  }
  std::vector<std::pair<std::size_t, double ErrorParts::*>> part_columns;
  for (const auto& [name, part] : stiffness_error_part_names) {
    const auto found = std::find(csv.columns.begin(), csv.columns.end(), part_column(name));
    if (found != csv.columns.end()) part_columns.emplace_back(found - csv.columns.begin(), part);
  }
  const auto cell = [&](std::size_t row, int c) { return csv.rows[row][column[c]]; };
  const auto refuse = [&](std::size_t row, const std::string& what) { throw csv.at_row(row, what); };
  const auto mesh = csv.header_value("mesh");
  if (!mesh) throw InputError(file.string() + ":1: no line '# mesh: NAME', such as \"# mesh: ring_planet\"");
  if (csv.rows.empty()) refuse(0, "no data");
  // A table that was cut short between its lines would be another one.
  const auto count = csv.header_value("rows");
  if (count && *count != std::to_string(csv.rows.size()))
    refuse(csv.rows.size() - 1, fmt::format("{} rows where the header has {}; is the file complete?", csv.rows.size(),
                                            count->substr(0, 20)));

  // The axes as the file shows them: loads run fastest, then phases, then positions.
  const std::size_t rows = csv.rows.size();
  std::size_t loads = 1, block = 1;
  while (loads < rows && cell(loads, 0) == cell(0, 0) && cell(loads, 1) == cell(0, 1)) ++loads;
  while (block < rows && cell(block, 1) == cell(0, 1)) ++block;
  // A ring that repeats with every tooth may still list its one position; a second position restarts at phase 0.
  for (std::size_t row = loads; row < block; row += loads)
    if (cell(row, 0) == cell(0, 0)) block = row;
  if (block % loads || rows % block) refuse(rows - 1, "the rows do not fill phases x ring positions x loads");
  const std::size_t phases = block / loads, positions = rows / block;

  std::vector<double> angles, load_values;
  std::vector<StiffnessEntry> entries;
  for (std::size_t i = 0; i < positions; ++i) angles.push_back(cell(i * block, 1) * units::deg);
  for (std::size_t i = 0; i < loads; ++i) {
    load_values.push_back(cell(i, 2));
    if (!(load_values[i] > (i ? load_values[i - 1] : 0.0))) refuse(i, "loads must be positive and strictly increasing");
  }
  for (std::size_t row = 0; row < rows; ++row) {
    const std::size_t position = row / block, phase = row % block / loads, load = row % loads;
    // 1e-9: phases written with fewer digits (0.333333333) are still the equidistant ones.
    const double expected = static_cast<double>(phase) / static_cast<double>(phases);
    if (!(std::abs(cell(row, 0) - expected) <= 1e-9))
      refuse(row, fmt::format("mesh_phase {} where {} equidistant phases have {}", cell(row, 0), phases, expected));
    if (cell(row, 1) != cell(position * block, 1)) refuse(row, "ring_angle_deg changes within a ring position");
    if (cell(row, 2) != load_values[load])
      refuse(row, fmt::format("load_N {} where the first rows have {}", cell(row, 2), load_values[load]));
    entries.push_back({cell(row, 3), cell(row, 4), cell(row, 5), cell(row, 6), cell(row, 7)});
    for (const auto& [at, part] : part_columns) entries.back().error_parts.*part = csv.rows[row][at];
    const auto what = complaint(entries.back(), load_values[load]);
    if (!what.empty()) refuse(row, what);
  }
  StiffnessTable table(*mesh, static_cast<int>(phases), std::move(angles), std::move(load_values), std::move(entries));
  for (const auto& line : csv.header)
    if (line.first != "mesh" && line.first != "rows") table.provenance.push_back(line);
  return table;
}

std::vector<double> periodic_slopes(const std::vector<double>& values) {
  const std::size_t n = values.size();
  // Slopes at the knots from Boost's makima over the values continued periodically: a slope depends on two neighbours
  // on either side, so three on either side keep Boost's end conditions out of the period.
  constexpr std::size_t pad = 3;
  std::vector<double> x(n + 2 * pad + 1), y(x.size());
  std::iota(x.begin(), x.end(), -static_cast<double>(pad));
  for (std::size_t i = 0; i < y.size(); ++i) y[i] = values[(i + n * pad - pad) % n];
  const UntrappedFloatingPoint untrapped;  // on a plateau makima divides zero by zero and mends it
  const boost::math::interpolators::makima<std::vector<double>> makima(std::move(x), std::move(y));
  std::vector<double> slopes(n);
  for (std::size_t i = 0; i < n; ++i) slopes[i] = makima.prime(static_cast<double>(i));
  return slopes;
}

PeriodicCurve::PeriodicCurve(const std::vector<double>& values, int values_per_unit) {
  const std::size_t n = values.size();
  if (n == 0 || values_per_unit < 1 || n % static_cast<std::size_t>(values_per_unit))
    throw InputError(fmt::format("a periodic curve needs whole mesh cycles of values, not {} values at {} per cycle", n,
                                 values_per_unit));
  for (const double value : values)
    if (!std::isfinite(value)) throw InputError("a periodic curve needs finite values");

  step_ = 1.0 / values_per_unit;
  period_ = static_cast<double>(n) / values_per_unit;
  // The slopes of the Hermite pieces telescope over the period: what is left of the integral is the plain average.
  mean_ = std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(n);
  values_ = values;
  values_.push_back(values.front());
  slopes_ = periodic_slopes(values);
  slopes_.push_back(slopes_.front());
}

namespace {

struct Knot {
  std::size_t index;
  double t;  ///< [0, 1] within the piece
};

/// The piece that holds `cycles`. Reduces by the period first, which keeps t accurate for large arguments.
Knot locate(double cycles, double period, double step, std::size_t pieces) {
  const double turns = cycles / period;
  const double x = (turns - std::floor(turns)) * (period / step);
  const auto index = std::min(static_cast<std::size_t>(x), pieces - 1);
  return {index, x - static_cast<double>(index)};
}

}  // namespace

double PeriodicCurve::operator()(double mesh_cycles) const {
  const auto [i, t] = locate(mesh_cycles, period_, step_, values_.size() - 1);
  const double rise = values_[i + 1] - values_[i];
  const double a = slopes_[i] - rise, b = rise - slopes_[i + 1];
  return values_[i] + t * (rise + (1 - t) * ((1 - t) * a + t * b));
}

double PeriodicCurve::derivative(double mesh_cycles) const {
  const auto [i, t] = locate(mesh_cycles, period_, step_, values_.size() - 1);
  const double rise = values_[i + 1] - values_[i];
  const double a = slopes_[i] - rise, b = rise - slopes_[i + 1];
  return (rise + (1 - t) * (1 - 3 * t) * a + t * (2 - 3 * t) * b) / step_;
}

int PeriodicCurve::pieces_per_unit() const { return static_cast<int>(std::lround(1 / step_)); }

std::array<double, 4> PeriodicCurve::coefficients(int piece) const {
  require(piece >= 0 && piece < pieces(), "piece of a periodic curve out of range");
  const double rise = values_[piece + 1] - values_[piece], first = slopes_[piece], last = slopes_[piece + 1];
  return {values_[piece], first, 3 * rise - 2 * first - last, first + last - 2 * rise};
}

MeshCurves curves_at_load(const StiffnessTable& table, double load) {
  const auto& loads = table.loads();
  constexpr double rounding = 1e-9;
  if (!(load >= loads.front() * (1 - rounding) && load <= loads.back() * (1 + rounding)))
    throw InputError(
        fmt::format("stiffness table {}: a load of {:g} N is outside the tabulated {:g} to {:g} N; "
                    "solve the mesh at loads that include it",
                    table.mesh(), load, loads.front(), loads.back()));
  std::size_t upper = 0;
  while (upper + 1 < loads.size() && loads[upper] < load) ++upper;
  const std::size_t lower = upper ? upper - 1 : 0;
  const double width = loads[upper] - loads[lower];
  const double weight = width > 0 ? (load - loads[lower]) / width : 0.0;

  std::vector<double> secant, tangent, unloaded, lte;
  for (int position = 0; position < table.positions(); ++position)
    for (int phase = 0; phase < table.phases(); ++phase) {
      const auto& a = table.at(position, phase, static_cast<int>(lower));
      const auto& b = table.at(position, phase, static_cast<int>(upper));
      secant.push_back(std::lerp(a.stiffness_secant, b.stiffness_secant, weight));
      tangent.push_back(std::lerp(a.stiffness_tangent, b.stiffness_tangent, weight));
      unloaded.push_back(std::lerp(a.unloaded_te, b.unloaded_te, weight));
      lte.push_back(std::lerp(a.lte, b.lte, weight));
    }
  const int n = table.phases();
  return {PeriodicCurve(secant, n), PeriodicCurve(tangent, n), PeriodicCurve(unloaded, n), PeriodicCurve(lte, n)};
}

}  // namespace annulus
