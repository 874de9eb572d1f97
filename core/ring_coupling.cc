#include "core/ring_coupling.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>

#include "core/csv.h"
#include "core/errors.h"

namespace annulus {
namespace {

// Symmetric to rounding of a file written with a few digits by hand.
constexpr double symmetry_tolerance = 1e-6;

/// What is wrong with a matrix, empty if nothing is.
std::string complaint(const Eigen::MatrixXd& matrix) {
  if (!matrix.allFinite()) return "a compliance is not finite";
  const double largest = matrix.cwiseAbs().maxCoeff();
  if ((matrix - matrix.transpose()).cwiseAbs().maxCoeff() > symmetry_tolerance * largest)
    return "the compliances are not symmetric";
  return {};
}

/// What is wrong with a mode, empty if nothing is. `lowest`: frequency of the mode before.
std::string complaint(const RingMode& mode, double lowest, int teeth) {
  bool finite = std::isfinite(mode.frequency) && std::isfinite(mode.translation_x) &&
                std::isfinite(mode.translation_y) && std::isfinite(mode.rotation);
  for (const double c : mode.deflection) finite = finite && std::isfinite(c);
  if (!finite) return "a value is not finite";
  if (mode.frequency <= 0) return "the frequency is not positive";
  if (mode.frequency < lowest) return "the frequencies do not rise";
  if (mode.waves < 0 || mode.waves > teeth / 2) return fmt::format("{} waves on {} teeth", mode.waves, teeth);
  return {};
}

/// What is wrong with the sizes, empty if nothing is.
std::string complaint(int planets, int teeth, double load, int per_cycle, std::size_t positions) {
  if (planets < 1) return "planets must be at least 1";
  if (teeth < 3) return "ring_teeth must be at least 3";
  if (!std::isfinite(load) || !(load > 0)) return "load_N must be positive";
  if (per_cycle < 1) return "per_cycle must be at least 1";
  if (positions == 0 || positions % per_cycle != 0 || teeth % (positions / per_cycle) != 0)
    return fmt::format("{} ring positions at {} per mesh cycle do not repeat around {} teeth", positions, per_cycle,
                       teeth);
  return {};
}

std::vector<std::string> compliance_columns(int planets) {
  std::vector<std::string> columns = {"ring_position"};
  for (int n = 1; n <= planets; ++n)
    for (int m = 1; m <= planets; ++m) columns.push_back(fmt::format("compliance_{}_{}_m_per_N", n, m));
  return columns;
}

std::vector<std::string> mode_columns(int teeth) {
  std::vector<std::string> columns = {"frequency_Hz", "waves", "translation_x_sqrt_kg", "translation_y_sqrt_kg",
                                      "rotation_sqrt_kg"};
  for (int tooth = 0; tooth < teeth; ++tooth) columns.push_back(fmt::format("deflection_{}_per_sqrt_kg", tooth));
  return columns;
}

const std::vector<std::string> header_keys = {"planets",   "ring_teeth", "load_N",
                                              "per_cycle", "mass_kg",    "rotational_mass_kg"};

double header_number(const Csv& csv, const std::string& key) {
  const auto text = csv.header_value(key);
  if (!text) throw InputError(fmt::format("{}:1: no line '# {}: ...'", csv.file, key));
  double value = 0;
  const auto [end, error] = std::from_chars(text->data(), text->data() + text->size(), value);
  if (error != std::errc{} || end != text->data() + text->size())
    throw InputError(fmt::format("{}:1: {} '{}' is not a number", csv.file, key, *text));
  return value;
}

int header_count(const Csv& csv, const std::string& key) {
  const double value = header_number(csv, key);
  if (value != std::round(value) || std::abs(value) > 1e6)
    throw InputError(fmt::format("{}:1: {} {} is not a whole number", csv.file, key, value));
  return static_cast<int>(value);
}

std::vector<std::size_t> find_columns(const Csv& csv, const std::vector<std::string>& names) {
  std::vector<std::size_t> places;
  places.reserve(names.size());
  for (const auto& name : names) places.push_back(csv.column(name));
  return places;
}

}  // namespace

void RingCoupling::write_csv(const std::filesystem::path& compliance_file,
                             const std::filesystem::path& modes_file) const {
  const auto refuse = [](const std::string& what) {
    if (!what.empty()) throw InputError("ring coupling: " + what);
  };
  refuse(complaint(planets, ring_teeth, load, per_cycle, compliance.size()));
  Csv csv;
  csv.header = {
      {"planets", fmt::format("{}", planets)},   {"ring_teeth", fmt::format("{}", ring_teeth)},
      {"load_N", fmt::format("{:.17g}", load)},  {"per_cycle", fmt::format("{}", per_cycle)},
      {"mass_kg", fmt::format("{:.17g}", mass)}, {"rotational_mass_kg", fmt::format("{:.17g}", rotational_mass)}};
  csv.header.insert(csv.header.end(), provenance.begin(), provenance.end());
  csv.columns = compliance_columns(planets);
  for (std::size_t i = 0; i < compliance.size(); ++i) {
    const auto& matrix = compliance[i];
    if (matrix.rows() != planets || matrix.cols() != planets)
      refuse(fmt::format("position {} has {} x {} compliances where {} planets need {} x {}", i, matrix.rows(),
                         matrix.cols(), planets, planets, planets));
    refuse(complaint(matrix));
    auto& row = csv.rows.emplace_back(1, static_cast<double>(i) / per_cycle);
    for (int n = 0; n < planets; ++n)
      for (int m = 0; m < planets; ++m) row.push_back(matrix(n, m));
  }

  Csv shapes;
  shapes.header = csv.header;
  shapes.columns = mode_columns(ring_teeth);
  double lowest = 0;
  for (const auto& mode : modes) {
    if (mode.deflection.size() != static_cast<std::size_t>(ring_teeth))
      refuse(fmt::format("a mode has {} deflections; the ring has {} teeth", mode.deflection.size(), ring_teeth));
    refuse(complaint(mode, lowest, ring_teeth));
    lowest = mode.frequency;
    auto& row = shapes.rows.emplace_back(std::vector<double>{mode.frequency, static_cast<double>(mode.waves),
                                                             mode.translation_x, mode.translation_y, mode.rotation});
    row.insert(row.end(), mode.deflection.begin(), mode.deflection.end());
  }
  csv.write(compliance_file);
  shapes.write(modes_file);
}

RingCoupling RingCoupling::read_csv(const std::filesystem::path& compliance_file,
                                    const std::filesystem::path& modes_file) {
  const auto refuse = [](const Csv& csv, std::size_t row, const std::string& what) {
    if (!what.empty()) throw csv.at_row(row, what);
  };
  const Csv csv = Csv::read(compliance_file);
  RingCoupling result;
  result.planets = header_count(csv, "planets");
  result.ring_teeth = header_count(csv, "ring_teeth");
  result.load = header_number(csv, "load_N");
  result.per_cycle = header_count(csv, "per_cycle");
  result.mass = header_number(csv, "mass_kg");
  result.rotational_mass = header_number(csv, "rotational_mass_kg");
  for (const double mass : {result.mass, result.rotational_mass})
    if (!std::isfinite(mass) || !(mass >= 0))
      throw InputError(fmt::format("{}:1: a mass of {} kg", compliance_file.string(), mass));
  const auto sizes = complaint(result.planets, result.ring_teeth, result.load, result.per_cycle, csv.rows.size());
  if (!sizes.empty()) throw InputError(fmt::format("{}:1: {}", compliance_file.string(), sizes));
  for (const auto& line : csv.header)
    if (std::find(header_keys.begin(), header_keys.end(), line.first) == header_keys.end())
      result.provenance.push_back(line);
  const auto column = find_columns(csv, compliance_columns(result.planets));
  for (std::size_t i = 0; i < csv.rows.size(); ++i) {
    const double expected = static_cast<double>(i) / result.per_cycle;
    // Written with fewer digits they are still the same positions.
    if (!(std::abs(csv.rows[i][column[0]] - expected) <= 1e-9 * (1 + expected)))
      refuse(csv, i, fmt::format("ring_position {} instead of {}", csv.rows[i][column[0]], expected));
    auto& matrix = result.compliance.emplace_back(result.planets, result.planets);
    for (int n = 0; n < result.planets; ++n)
      for (int m = 0; m < result.planets; ++m) matrix(n, m) = csv.rows[i][column[1 + n * result.planets + m]];
    refuse(csv, i, complaint(matrix));
  }

  const Csv shapes = Csv::read(modes_file);
  if (header_count(shapes, "ring_teeth") != result.ring_teeth)
    throw InputError(fmt::format("{}:1: ring_teeth differs from {} in {}", modes_file.string(), result.ring_teeth,
                                 compliance_file.string()));
  const auto place = find_columns(shapes, mode_columns(result.ring_teeth));
  double lowest = 0;
  for (std::size_t i = 0; i < shapes.rows.size(); ++i) {
    const auto cell = [&](std::size_t c) { return shapes.rows[i][place[c]]; };
    RingMode mode;
    mode.frequency = cell(0);
    if (!(std::abs(cell(1)) < 1e6) || cell(1) != std::round(cell(1)))
      refuse(shapes, i, fmt::format("waves {} is not a whole number", cell(1)));
    mode.waves = static_cast<int>(cell(1));
    mode.translation_x = cell(2);
    mode.translation_y = cell(3);
    mode.rotation = cell(4);
    for (int tooth = 0; tooth < result.ring_teeth; ++tooth) mode.deflection.push_back(cell(5 + tooth));
    refuse(shapes, i, complaint(mode, lowest, result.ring_teeth));
    lowest = mode.frequency;
    result.modes.push_back(std::move(mode));
  }
  return result;
}

}  // namespace annulus
