#include "app/systems/planetary/carrier_pins.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>
#include <string>
#include <utility>

#include "app/systems/planetary/planetary_input.h"
#include "app/systems/planetary/point_stiffness.h"
#include "app/systems/planetary/stage_supports.h"
#include "app/systems/planetary/structure_input.h"
#include "app/systems/shared/space_input.h"
#include "core/errors.h"
#include "dynamics/spatial/carrier_structure.h"

namespace annulus::app {

namespace {

using dynamics::EndStiffness;
using dynamics::Side;

/// One pin in rigid walls.
EndStiffness pin_in_walls(const Scene& scene) {
  const auto beam = pin_of(scene);
  const double length = planetary(scene).supports.pin_length.value_or(0);
  if (planetary(scene).supports.planet_pin == PinMounting::between_walls)
    return dynamics::beam_end(beam, beam, length / 2, Side::low) +
           dynamics::beam_end(beam, beam, length / 2, Side::high);
  if (planetary(scene).supports.planet_pin == PinMounting::cantilever)
    return dynamics::beam_end(beam, beam, length, Side::low);
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
  const auto& structure = scene.own<StructureInput>().carrier;
  if (structure && structure->file) return turned(structure->stiffness, planet_angles);
  if (structure) {
    dynamics::TwoWallCarrier carrier;
    carrier.planet_angles = planet_angles;
    carrier.radius = radius;
    carrier.pin = pin_of(scene);
    carrier.pin_length = *planetary(scene).supports.pin_length;
    carrier.webs = *structure->webs;
    carrier.web_radius = *structure->web_circle / 2;
    carrier.web_length = *structure->web_length;
    carrier.web_width = *structure->web_width;
    carrier.web_depth = *structure->web_depth;
    const double to_second = planet_angles.size() > 1 ? planet_angles[1] / 2 : M_PI;
    carrier.first_web = structure->first_web.value_or(structure->mirrored ? to_second - M_PI : to_second);
    carrier.youngs_modulus = scene.material.youngs_modulus;
    carrier.poisson_ratio = scene.material.poisson_ratio;
    carrier.shaft = structure->shaft;
    return dynamics::pins_stiffness(carrier);
  }
  if (planetary(scene).supports.planet_pin == PinMounting::unbending) return std::nullopt;
  const auto size = 5 * static_cast<Eigen::Index>(planet_angles.size());
  Eigen::MatrixXd all = Eigen::MatrixXd::Zero(size, size);
  for (Eigen::Index first = 0; first < size; first += 5) all.block<5, 5>(first, first) = pin_in_walls(scene);
  return all;
}

Eigen::MatrixXd read_carrier_stiffness(const std::filesystem::path& file, int planets) {
  std::vector<std::string> names;
  for (int n = 0; n < planets; ++n) names.push_back(dynamics::name_of_body({dynamics::StageBody::Kind::planet, n}));
  auto read = read_point_stiffness(file, names, {}, "the carrier's shaft held");
  if (read.points != names)
    throw InputError(fmt::format("has the points {}: {} planets have 5 or 6 coordinates each",
                                 fmt::join(read.points, ", "), planets));
  return std::move(read.stiffness);
}

}  // namespace annulus::app
