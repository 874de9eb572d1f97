#include "geometry/flank_topography.h"

#include <fmt/format.h>

#include <algorithm>
#include <boost/math/interpolators/makima.hpp>
#include <boost/math/quadrature/gauss.hpp>
#include <cmath>
#include <functional>
#include <limits>
#include <map>
#include <set>
#include <utility>

#include "core/csv.h"
#include "core/errors.h"
#include "core/floating_point.h"
#include "core/units.h"

namespace annulus::geometry {

namespace {

constexpr std::size_t fewest = 4;  // that local cubics need

void check_axis(const std::vector<double>& values, const char* name, bool one_is_enough) {
  if (values.size() < fewest && !(one_is_enough && values.size() == 1))
    throw GeometryError(fmt::format("a flank topography needs at least {} {}{}, and has {}", fewest, name,
                                    one_is_enough ? ", or one" : "", values.size()));
  if (std::adjacent_find(values.begin(), values.end(), std::greater_equal<>()) != values.end())
    throw GeometryError(fmt::format("the {} of a flank topography have to rise", name));
}

}  // namespace

struct FlankCurve::Cubics {
  boost::math::interpolators::makima<std::vector<double>> curve;
};

FlankCurve::FlankCurve(const std::vector<double>& radii, std::vector<double> values)
    : low_(radii.front()), high_(radii.back()) {
  const UntrappedFloatingPoint untrapped;  // on a plateau makima divides zero by zero and mends it
  curve_ = std::make_shared<Cubics>(
      Cubics{boost::math::interpolators::makima<std::vector<double>>(std::vector<double>(radii), std::move(values))});
}

double FlankCurve::operator()(double radius) const {
  return curve_ ? curve_->curve(std::clamp(radius, low_, high_)) : 0.0;
}

FlankTopography::FlankTopography(std::vector<double> radii, std::vector<double> positions, Eigen::MatrixXd removed)
    : radii_(std::move(radii)), positions_(std::move(positions)), removed_(std::move(removed)) {
  check_axis(radii_, "diameters", false);
  check_axis(positions_, "positions along the face", true);
  if (removed_.rows() != static_cast<Eigen::Index>(radii_.size()) ||
      removed_.cols() != static_cast<Eigen::Index>(positions_.size()))
    throw GeometryError(fmt::format("a flank topography of {} diameters and {} positions has {} x {} values",
                                    radii_.size(), positions_.size(), removed_.rows(), removed_.cols()));
  const auto finite = [](double value) { return std::isfinite(value); };
  if (!removed_.allFinite() || !std::all_of(radii_.begin(), radii_.end(), finite) ||
      !std::all_of(positions_.begin(), positions_.end(), finite))
    throw GeometryError("a flank topography has values that are not finite");
  if (!(radii_.front() > 0)) throw GeometryError("the diameters of a flank topography have to be positive");
}

bool FlankTopography::varies_along_face() const {
  return removed_.cols() > 1 && (removed_.colwise() - removed_.col(0)).cwiseAbs().maxCoeff() > 0;
}

FlankTopography::Slice FlankTopography::slice(double low, double high) const {
  if (!varies_along_face()) return {FlankCurve(radii_, {removed_.col(0).begin(), removed_.col(0).end()})};
  std::vector<double> mean;
  std::vector<std::vector<double>> across(slice_places);
  for (Eigen::Index i = 0; i < removed_.rows(); ++i) {
    const FlankCurve curve(positions_, {removed_.row(i).begin(), removed_.row(i).end()});
    // Of the mean of a piece of a cubic nothing is left out, and where the grid has several in a slice little.
    mean.push_back(boost::math::quadrature::gauss<double, 15>::integrate(curve, low, high) / (high - low));
    for (int k = 0; k < slice_places; ++k)
      across[static_cast<std::size_t>(k)].push_back(curve(low + (high - low) * k / (slice_places - 1)));
  }
  Slice slice{FlankCurve(radii_, std::move(mean))};
  for (auto& values : across) slice.across.emplace_back(radii_, std::move(values));
  return slice;
}

FlankTopography read_flank_topography(const std::filesystem::path& file) {
  const Csv csv = Csv::read(file);
  const std::size_t diameter = csv.column("diameter_mm"), position = csv.column("position_mm"),
                    removed = csv.column("removed_um");
  constexpr double largest = 1000;  // um, of a modification elsewhere
  std::set<double> diameters, positions;
  std::map<std::pair<double, double>, double> values;
  for (std::size_t i = 0; i < csv.rows.size(); ++i) {
    const auto& row = csv.rows[i];
    for (const std::size_t c : {diameter, position, removed})
      if (!std::isfinite(row[c])) throw csv.at_row(i, csv.columns[c] + " is not a finite number");
    if (!(row[diameter] > 0)) throw csv.at_row(i, "diameter_mm has to be above zero");
    if (!(std::abs(row[removed]) <= largest))
      throw csv.at_row(
          i, fmt::format("removed_um is {:.6g}; it has to lie between -{} and {} µm", row[removed], largest, largest));
    diameters.insert(row[diameter]);
    positions.insert(row[position]);
    if (!values.emplace(std::pair(row[diameter], row[position]), row[removed]).second)
      throw csv.at_row(i, fmt::format("the point at diameter_mm = {} and position_mm = {} stands there twice",
                                      row[diameter], row[position]));
  }
  std::vector<double> radii, places(positions.begin(), positions.end());
  Eigen::MatrixXd grid(static_cast<Eigen::Index>(diameters.size()), static_cast<Eigen::Index>(places.size()));
  for (const double d : diameters) {
    for (std::size_t j = 0; j < places.size(); ++j) {
      const auto found = values.find({d, places[j]});
      if (found == values.end())
        throw csv.at_columns(
            fmt::format("is no grid: of {} diameters and {} positions, the point at diameter_mm = {} "
                        "and position_mm = {} is missing",
                        diameters.size(), places.size(), d, places[j]));
      grid(static_cast<Eigen::Index>(radii.size()), static_cast<Eigen::Index>(j)) = found->second * units::um;
    }
    radii.push_back(d / 2 * units::mm);
  }
  for (double& z : places) z *= units::mm;
  try {
    return {std::move(radii), std::move(places), std::move(grid)};
  } catch (const GeometryError& error) {
    throw csv.at_columns(error.what());
  }
}

}  // namespace annulus::geometry
