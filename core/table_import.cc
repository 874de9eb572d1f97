#include "core/table_import.h"

#include <fmt/format.h>

#include <algorithm>
#include <boost/math/interpolators/makima.hpp>
#include <cmath>
#include <map>
#include <optional>

#include "core/csv.h"
#include "core/errors.h"
#include "core/floating_point.h"
#include "core/units.h"

namespace annulus {

namespace {

struct Column {
  std::size_t at;
  double si;
};

/// The first of some columns that the file has.
std::optional<Column> find(const Csv& csv, std::initializer_list<std::pair<const char*, double>> names) {
  for (const auto& [name, si] : names) {
    const auto found = std::find(csv.columns.begin(), csv.columns.end(), name);
    if (found != csv.columns.end()) return Column{static_cast<std::size_t>(found - csv.columns.begin()), si};
  }
  return std::nullopt;
}

/// One point of one curve.
struct Sample {
  double cycles, deflection_per_newton, unloaded, error;
  std::size_t line;
};

constexpr int least_phases = 64, most_cycles = 2000;  // no ring repeats later than after all its teeth
constexpr std::size_t most_entries = 10'000'000;
// Phases written with fewer digits are still the same; stiffnesses may be rounded to a few digits by hand, as in
// StiffnessTable.
constexpr double same_phase = 1e-9, closing_tolerance = 1e-3;

/// A quantity of samples over one whole period, at equidistant places.
std::vector<double> resampled(const std::vector<Sample>& samples, double Sample::*value, double period, int count) {
  const std::size_t n = samples.size();
  // A slope depends on two neighbours on either side, so three repeated ones keep the ends out of the period.
  constexpr std::size_t pad = 3;
  std::vector<double> x, y;
  const std::size_t turns = (pad + n - 1) / n;  // whole periods that `pad` samples reach back into
  for (std::size_t i = 0; i < n + 2 * pad + 1; ++i) {
    const std::size_t k = i + n * turns - pad;
    const std::size_t turn = k / n;
    x.push_back(samples[k % n].cycles + (static_cast<double>(turn) - static_cast<double>(turns)) * period);
    y.push_back(samples[k % n].*value);
  }
  const UntrappedFloatingPoint untrapped;  // on a plateau makima divides zero by zero and mends it
  const boost::math::interpolators::makima<std::vector<double>> curve(std::move(x), std::move(y));
  // Phases before the first sample are those after the last one.
  const auto place = [&](int i) {
    const double cycles = period * i / count;
    return cycles < samples.front().cycles ? cycles + period : cycles;
  };
  std::vector<double> values;
  values.reserve(static_cast<std::size_t>(count));
  for (int i = 0; i < count; ++i) values.push_back(curve(place(i)));
  return values;
}

bool equidistant(const std::vector<Sample>& samples, double period) {
  for (std::size_t i = 0; i < samples.size(); ++i)
    if (std::abs(samples[i].cycles - period * static_cast<double>(i) / static_cast<double>(samples.size())) >
        same_phase)
      return false;
  return true;
}

/// What the columns say, load by load, phases rising and without the closing row.
class Curves {
 public:
  explicit Curves(const Csv& csv) : csv_(csv) {
    const auto phase = find(csv, {{"mesh_phase", 1}, {"mesh_cycles", 1}, {"mesh_phase_deg", 1.0 / 360}});
    const auto stiffness =
        find(csv, {{"stiffness_N_per_m", 1}, {"stiffness_N_per_um", 1e6}, {"stiffness_secant_N_per_m", 1}});
    const auto lte = find(csv, {{"lte_m", 1}, {"lte_um", units::um}});
    const auto load = find(csv, {{"load_N", 1}});
    const auto unloaded = find(csv, {{"unloaded_te_m", 1}, {"unloaded_te_um", units::um}});
    const auto error = find(csv, {{"error_relative", 1}});
    const auto refuse = [&](const std::string& what) {
      throw csv.at_columns(fmt::format("is not a stiffness table: {}; there are: {}", what, csv.column_names()));
    };
    if (!phase) refuse("no column mesh_phase, mesh_phase_deg or mesh_cycles");
    if (!stiffness && !lte) refuse("no column stiffness_N_per_m, stiffness_N_per_um, lte_m or lte_um");
    if (!stiffness && !load) refuse("lte needs a column load_N beside it");
    if (csv.rows.empty()) refuse("no data");
    for (std::size_t i = 0; i < csv.rows.size(); ++i) {
      const auto& row = csv.rows[i];
      for (const auto& c : {phase, stiffness, lte, load, unloaded, error})
        if (c && !std::isfinite(row[c->at])) refuse_row(i, csv.columns[c->at] + " is not a finite number");
      const auto value = [&](const std::optional<Column>& c, double otherwise) {
        return c ? row[c->at] * c->si : otherwise;
      };
      Sample s{value(phase, 0), 0, value(unloaded, 0), value(error, 0), i};
      const double force = value(load, any_load);
      if (!(force > 0 && force <= 1e30)) refuse_row(i, "load_N has to be above zero");
      if (!(s.cycles >= 0 && s.cycles <= most_cycles))
        refuse_row(i, fmt::format("the phase has to lie between zero and {} mesh cycles", most_cycles));
      if (!(std::abs(s.unloaded) <= 1)) refuse_row(i, "unloaded_te has to be a length below a metre");
      if (!(s.error >= 0 && s.error <= 1e3)) refuse_row(i, "error_relative has to be a number from zero on");
      if (stiffness && !(value(stiffness, 0) >= 1e-3 && value(stiffness, 0) <= 1e30))
        refuse_row(i, "the stiffness has to be above zero");
      s.deflection_per_newton = stiffness ? 1 / value(stiffness, 0) : (value(lte, 0) - s.unloaded) / force;
      if (!(s.deflection_per_newton >= 1e-30 && s.deflection_per_newton <= 1e3))
        refuse_row(i, "lte has to exceed unloaded_te: the load deflects the mesh");
      by_load[force].push_back(s);
    }
    double last = 0;
    for (auto& [force, samples] : by_load) {
      std::stable_sort(samples.begin(), samples.end(),
                       [](const auto& a, const auto& b) { return a.cycles < b.cycles; });
      last = std::max(last, samples.back().cycles);
    }
    // A last row at a whole number closes the period; else the period is the next whole number.
    const bool closed = std::abs(last - std::round(last)) <= same_phase && std::round(last) >= 1;
    period = closed ? std::round(last) : std::floor(last) + 1;
    for (auto& [force, samples] : by_load) tidy(samples);
  }

  [[noreturn]] void refuse_row(std::size_t row, const std::string& what) const { throw csv_.at_row(row, what); }

  static constexpr double any_load = 1;
  std::map<double, std::vector<Sample>> by_load{};
  double period = 1;  ///< mesh cycles, whole

 private:
  void tidy(std::vector<Sample>& samples) const {
    const Sample end = samples.back();
    if (std::abs(end.cycles - period) <= same_phase) {
      const double a = end.deflection_per_newton, b = samples.front().deflection_per_newton;
      if (samples.size() > 1 && samples.front().cycles <= same_phase && std::abs(a - b) > closing_tolerance * b)
        refuse_row(
            end.line,
            fmt::format(
                "the deflection at the end of the period is {:.4g} of that at its beginning; they have to be equal",
                a / b));
      samples.pop_back();
    }
    if (static_cast<double>(samples.size()) < 4 * period)
      refuse_row(end.line,
                 fmt::format("{} phases over {} mesh cycles: at least four phases are needed for each load and cycle",
                             samples.size(), period));
    if (period - samples.back().cycles <= same_phase) refuse_row(samples.back().line, "the same phase twice");
    for (std::size_t i = 1; i < samples.size(); ++i)
      if (samples[i].cycles - samples[i - 1].cycles <= same_phase) refuse_row(samples[i].line, "the same phase twice");
  }

  const Csv& csv_;
};

bool native(const Csv& csv) {
  for (const char* name : {"ring_angle_deg", "stiffness_secant_N_per_m", "stiffness_tangent_N_per_m"})
    if (std::find(csv.columns.begin(), csv.columns.end(), name) == csv.columns.end()) return false;
  return true;
}

}  // namespace

StiffnessTable import_table(const std::filesystem::path& file, const std::string& mesh) {
  const Csv csv = Csv::read(file);
  if (native(csv)) {
    auto table = StiffnessTable::read_csv(file);
    if (table.mesh() != mesh)
      throw InputError(fmt::format("{}: is the table of the mesh {}, not of {}", file.string(), table.mesh(), mesh));
    return table;
  }
  const Curves curves(csv);
  const int positions = static_cast<int>(curves.period);
  std::size_t most = 0;
  bool even = true;
  for (const auto& [force, samples] : curves.by_load) {
    even = even && equidistant(samples, curves.period) && (most == 0 || samples.size() == most);
    most = std::max(most, samples.size());
  }
  even = even && most % static_cast<std::size_t>(positions) == 0;
  const int per_cycle =
      even ? static_cast<int>(most) / positions
           : std::max(least_phases, static_cast<int>(std::ceil(static_cast<double>(most) / positions)));
  const int count = per_cycle * positions;
  if (static_cast<std::size_t>(count) * curves.by_load.size() > most_entries)
    throw InputError(fmt::format("{}:1: {} loads at {} positions make more than {} entries", file.string(),
                                 curves.by_load.size(), count, most_entries));

  // [load][place]
  std::vector<double> loads;
  std::vector<std::vector<double>> deflection, unloaded, error;
  for (const auto& [force, samples] : curves.by_load) {
    loads.push_back(force);
    const auto values = [&, &places = samples](double Sample::*value) {
      if (!even) return resampled(places, value, curves.period, count);
      std::vector<double> list;
      list.reserve(places.size());
      for (const auto& s : places) list.push_back(s.*value);
      return list;
    };
    deflection.push_back(values(&Sample::deflection_per_newton));
    unloaded.push_back(values(&Sample::unloaded));
    error.push_back(values(&Sample::error));
  }
  const bool law = loads.size() > 1;
  if (!law) {
    // From next to nothing to more than any gear bears: linear between.
    loads = {1e-6, 1e12};
    for (auto* list : {&deflection, &unloaded, &error}) list->push_back(list->front());
  }
  std::vector<StiffnessEntry> entries;
  for (int i = 0; i < count; ++i) {
    for (std::size_t l = 0; l < loads.size(); ++l) {
      // Before the first load the stiffness is that at it.
      const std::size_t a = l == 0 ? 0 : l - 1, b = std::min(l + 1, loads.size() - 1);
      const auto place = static_cast<std::size_t>(i);
      const auto at = [&](std::size_t k) { return deflection[k][place] * loads[k]; };
      const double tangent = law ? (loads[b] - loads[a]) / (at(b) - at(a)) : 1 / deflection[l][place];
      if (!(tangent > 0 && deflection[l][place] > 0))
        throw InputError(fmt::format("{}:1: at phase {:.4g} the deflection does not rise with the load", file.string(),
                                     static_cast<double>(i) / per_cycle));
      entries.push_back({.unloaded_te = unloaded[l][place],
                         .lte = unloaded[l][place] + at(l),
                         .stiffness_secant = 1 / deflection[l][place],
                         .stiffness_tangent = tangent,
                         .error_relative = std::max(0.0, error[l][place])});
    }
  }
  std::vector<double> angles(static_cast<std::size_t>(positions));
  for (int i = 0; i < positions; ++i) angles[static_cast<std::size_t>(i)] = i;  // it only distinguishes them
  StiffnessTable table(mesh, per_cycle, std::move(angles), std::move(loads), std::move(entries));
  table.provenance = {{"imported_from", file.filename().string()}, {"resampled", even ? "no" : "yes"}};
  return table;
}

}  // namespace annulus
