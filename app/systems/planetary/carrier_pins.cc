#include "app/systems/planetary/carrier_pins.h"

#include <fmt/format.h>

#include <Eigen/LU>
#include <cmath>
#include <string>
#include <utility>

#include "app/systems/planetary/space_input.h"
#include "app/systems/planetary/stage_supports.h"
#include "core/csv.h"
#include "core/errors.h"
#include "dynamics/spatial/carrier_structure.h"
#include "dynamics/spatial/elastic_laws.h"

namespace annulus::app {

namespace {

using dynamics::EndStiffness;
using dynamics::Side;

/// One pin in rigid walls.
EndStiffness pin_in_walls(const Scene& scene) {
  const auto beam = pin_of(scene);
  const double length = scene.supports.pin_length.value_or(0);
  if (scene.supports.planet_pin == PinMounting::between_walls)
    return dynamics::beam_end(beam, beam, length / 2, Side::low) +
           dynamics::beam_end(beam, beam, length / 2, Side::high);
  if (scene.supports.planet_pin == PinMounting::cantilever) return dynamics::beam_end(beam, beam, length, Side::low);
  // The force on a flexpin passes through its middle: its end does not turn.
  EndStiffness all = EndStiffness::Zero();
  all(0, 0) = all(1, 1) = 1 / beam.parallel_shift(length);
  all(3, 3) = all(4, 4) = 1 / beam.cantilever_bend(length);
  all(2, 2) = beam.axial / length;
  return all;
}

/// In the axes of every planet.
Eigen::MatrixXd turned(const Eigen::MatrixXd& of_carrier, const std::vector<double>& planet_angles) {
  Eigen::MatrixXd axes = Eigen::MatrixXd::Identity(of_carrier.rows(), of_carrier.cols());
  for (std::size_t n = 0; n < planet_angles.size(); ++n) {
    const double c = std::cos(planet_angles[n]), s = std::sin(planet_angles[n]);
    for (const Eigen::Index from : {0, 3}) {
      const Eigen::Index i = 5 * static_cast<Eigen::Index>(n) + from;
      axes.block<2, 2>(i, i) << c, s, -s, c;
    }
  }
  return axes * of_carrier * axes.transpose();
}

}  // namespace

std::optional<Eigen::MatrixXd> pins_in_space(const Scene& scene, const std::vector<double>& planet_angles,
                                             double radius) {
  const auto& structure = scene.own<SpaceInput>().carrier_structure;
  if (structure && structure->file) return turned(structure->stiffness, planet_angles);
  if (structure) {
    dynamics::TwoWallCarrier carrier;
    carrier.planet_angles = planet_angles;
    carrier.radius = radius;
    carrier.pin = pin_of(scene);
    carrier.pin_length = *scene.supports.pin_length;
    carrier.webs = *structure->webs;
    carrier.web_radius = *structure->web_circle / 2;
    carrier.web_length = *structure->web_length;
    carrier.web_width = *structure->web_width;
    carrier.web_depth = *structure->web_depth;
    carrier.first_web = structure->first_web.value_or(M_PI / scene.stage.planets);
    carrier.youngs_modulus = scene.material.youngs_modulus;
    carrier.poisson_ratio = scene.material.poisson_ratio;
    carrier.shaft = structure->shaft;
    return dynamics::pins_stiffness(carrier);
  }
  if (scene.supports.planet_pin == PinMounting::unbending) return std::nullopt;
  const auto size = 5 * static_cast<Eigen::Index>(planet_angles.size());
  Eigen::MatrixXd all = Eigen::MatrixXd::Zero(size, size);
  for (Eigen::Index first = 0; first < size; first += 5) all.block<5, 5>(first, first) = pin_in_walls(scene);
  return all;
}

Eigen::MatrixXd read_carrier_stiffness(const std::filesystem::path& file, int planets) {
  const auto csv = Csv::read(file);
  std::vector<std::string> names;
  const auto each = csv.columns.size() == 6 * static_cast<std::size_t>(planets) ? 6 : 5;
  for (int n = 1; n <= planets; ++n)
    for (const auto* what : {"x_m", "y_m", "z_m", "about_x_rad", "about_y_rad", "about_z_rad"})
      if (std::string(what) != "about_z_rad" || each == 6) names.push_back(fmt::format("planet{}_{}", n, what));
  if (csv.columns.size() != names.size() || csv.rows.size() != names.size())
    throw InputError(fmt::format("has {} columns and {} rows of numbers; {} planets have 5 or 6 coordinates each",
                                 csv.columns.size(), csv.rows.size(), planets));
  const auto size = static_cast<Eigen::Index>(names.size());
  Eigen::MatrixXd given(size, size);
  for (Eigen::Index i = 0; i < size; ++i) {
    const auto& name = csv.columns[static_cast<std::size_t>(i)];
    if (name != names[static_cast<std::size_t>(i)])
      throw InputError(fmt::format("column {} is '{}', not '{}'", i + 1, name, names[static_cast<std::size_t>(i)]));
    for (Eigen::Index j = 0; j < size; ++j)
      given(i, j) = csv.rows[static_cast<std::size_t>(i)][static_cast<std::size_t>(j)];
  }
  (void)dynamics::LinearLaw(given);  // symmetric, and gives no energy away
  if (each == 6) {
    Eigen::MatrixXd kept(5 * planets, size), turning(planets, size);
    for (int n = 0; n < planets; ++n) {
      kept.middleRows<5>(static_cast<Eigen::Index>(5 * n)) =
          Eigen::MatrixXd::Identity(size, size).middleRows<5>(static_cast<Eigen::Index>(6 * n));
      turning.row(n) = Eigen::RowVectorXd::Unit(size, 6 * n + 5);
    }
    const Eigen::FullPivLU<Eigen::MatrixXd> own(turning * given * turning.transpose());
    if (!own.isInvertible())
      throw InputError("a pin can turn about its own axis and nothing resists: leave out the columns about_z_rad");
    given = (kept * given * kept.transpose() -
             kept * given * turning.transpose() * own.solve(turning * given * kept.transpose()))
                .eval();
  }
  const Eigen::VectorXd scale = given.diagonal().cwiseMax(0).cwiseSqrt();
  if (!(scale.minCoeff() > 0) ||
      !Eigen::FullPivLU<Eigen::MatrixXd>(scale.cwiseInverse().asDiagonal() * given * scale.cwiseInverse().asDiagonal())
           .isInvertible())
    throw InputError(
        "holds the pins not in all directions: it is the stiffness with the carrier's shaft held, in which no motion "
        "of "
        "the pins is free");
  return (given + given.transpose()) / 2;
}

}  // namespace annulus::app
