#include "app/systems/planetary/point_stiffness.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>

#include "core/csv.h"
#include "core/errors.h"
#include "dynamics/spatial/elastic_laws.h"

namespace annulus::app {

namespace {

constexpr std::array<const char*, 6> coordinates{"x_m", "y_m", "z_m", "about_x_rad", "about_y_rad", "about_z_rad"};

/// Columns of the file: of the coordinates that stay, and of those on which nothing acts.
struct Columns {
  std::vector<Eigen::Index> kept, condensed;
};

Columns columns_of(const Csv& csv, const std::vector<std::string>& known, const std::vector<std::string>& turning,
                   PointStiffness& result) {
  const auto column = [&](const std::string& name) -> Eigen::Index {
    const auto found = std::find(csv.columns.begin(), csv.columns.end(), name);
    return found == csv.columns.end() ? -1 : found - csv.columns.begin();
  };
  Columns columns;
  std::vector<bool> used(csv.columns.size());
  Eigen::Index last = -1;
  for (const auto& point : known) {
    std::array<Eigen::Index, 6> place{};
    for (std::size_t i = 0; i < 6; ++i) {
      place.at(i) = column(fmt::format("{}_{}", point, coordinates.at(i)));
      if (place.at(i) >= 0) used[static_cast<std::size_t>(place.at(i))] = true;
    }
    if (std::all_of(place.begin(), place.end(), [](auto i) { return i < 0; })) continue;
    for (std::size_t i = 0; i < 5; ++i)
      if (place.at(i) < 0) throw InputError(fmt::format("has no column {}_{}", point, coordinates.at(i)));
    result.points.push_back(point);
    columns.kept.insert(columns.kept.end(), place.begin(), place.begin() + 5);
    if (place[5] < 0) continue;
    if (std::find(turning.begin(), turning.end(), point) == turning.end()) {
      columns.condensed.push_back(place[5]);
      continue;
    }
    if (last >= 0)
      throw InputError(
          fmt::format("contains rotations about z of several of the points {}, in which a torque enters: "
                      "leave all of them out but one",
                      fmt::join(turning, ", ")));
    last = place[5];
  }
  for (std::size_t i = 0; i < used.size(); ++i)
    if (!used[i])
      throw InputError(
          fmt::format("column {} is '{}': its columns are <point>_x_m, _y_m, _z_m, _about_x_rad, "
                      "_about_y_rad and, if need be, _about_z_rad, and its points {}",
                      i + 1, csv.columns[i], fmt::join(known, ", ")));
  result.turns = last >= 0;
  if (result.turns) columns.kept.push_back(last);
  return columns;
}

/// Numbers of few digits differ across the diagonal.
void check_entries(const Csv& csv, const Eigen::MatrixXd& given) {
  constexpr double digits = 1e-5;
  const auto name = [&](Eigen::Index i) { return csv.columns[static_cast<std::size_t>(i)]; };
  for (Eigen::Index i = 0; i < given.rows(); ++i)
    if (!(given(i, i) >= 0) || !std::isfinite(given(i, i)))
      throw InputError(fmt::format("has {:g} in row and column {}: nothing resists this motion", given(i, i), name(i)));
  for (Eigen::Index i = 0; i < given.rows(); ++i)
    for (Eigen::Index j = 0; j < i; ++j)
      if (!(std::abs(given(i, j) - given(j, i)) <= digits * std::sqrt(given(i, i) * given(j, j))))
        throw InputError(fmt::format("is not symmetric: {:g} and {:g} between {} and {}", given(i, j), given(j, i),
                                     name(i), name(j)));
}

}  // namespace

PointStiffness read_point_stiffness(const std::filesystem::path& file, const std::vector<std::string>& known,
                                    const std::vector<std::string>& turning, const std::string& held) {
  const auto csv = Csv::read(file);
  PointStiffness result;
  const auto columns = columns_of(csv, known, turning, result);
  const auto size = std::ssize(csv.columns);
  if (std::ssize(csv.rows) != size)
    throw InputError(fmt::format("has {} columns and {} rows of numbers: it is a square table", size, csv.rows.size()));
  Eigen::MatrixXd given(size, size);
  for (Eigen::Index i = 0; i < size; ++i)
    for (Eigen::Index j = 0; j < size; ++j)
      given(i, j) = csv.rows[static_cast<std::size_t>(i)][static_cast<std::size_t>(j)];
  check_entries(csv, given);
  given = (given + given.transpose()).eval() / 2;
  (void)dynamics::LinearLaw(given);  // gives no energy away
  Eigen::MatrixXd& kept = result.stiffness;
  kept = given(columns.kept, columns.kept);
  if (!columns.condensed.empty()) {
    const Eigen::FullPivLU<Eigen::MatrixXd> own(given(columns.condensed, columns.condensed));
    if (!own.isInvertible())
      throw InputError(
          "a point can turn about z, where nothing acts on it, and nothing resists: leave out the columns about_z_rad");
    const Eigen::MatrixXd beside = given(columns.condensed, columns.kept);
    kept -= beside.transpose() * own.solve(beside);
  }
  const Eigen::VectorXd scale = kept.diagonal().cwiseMax(0).cwiseSqrt();
  if (!(scale.minCoeff() > 0) ||
      !Eigen::FullPivLU<Eigen::MatrixXd>(scale.cwiseInverse().asDiagonal() * kept * scale.cwiseInverse().asDiagonal())
           .isInvertible())
    throw InputError(fmt::format(
        "holds the points not in all directions: it is the stiffness with {}, in which no motion is free", held));
  kept = (kept + kept.transpose()).eval() / 2;
  return result;
}

}  // namespace annulus::app
