#include <Eigen/Dense>
#include <algorithm>
#include <boost/test/unit_test.hpp>
#include <cmath>
#include <memory>
#include <string>

#include "core/errors.h"
#include "dynamics/spatial/elastic_laws.h"
#include "dynamics/spatial/rolling_rows.h"
#include "dynamics/spatial/series_law.h"
#include "tests/dynamics/spatial_stages.h"
#include "tests/verification_record.h"

/// Bearings on something that gives way.
BOOST_AUTO_TEST_SUITE(series_law)

using namespace annulus::dynamics;
using Eigen::MatrixXd;
using Eigen::Vector2d;
using Eigen::VectorXd;

BOOST_AUTO_TEST_CASE(stop_on_a_spring) {
  annulus::test::Verification record("Bearing in series with what it stands on", "stop and spring in closed form");
  constexpr double k = 4e8, below = 1e8, play = 30e-6;
  const SeriesLaw law(below * MatrixXd::Identity(2, 2),
                      {{MatrixXd::Identity(2, 2), std::make_shared<StopLaw>(2, k, play)}}, MatrixXd(0, 2));
  for (const double distance : {31e-6, 60e-6, 1e-3}) {
    const Vector2d direction(0.6, -0.8);
    const auto state = law.at(distance * direction);
    const double both = k * below / (k + below), force = both * (distance - play);
    record.at_most("force over that in closed form, difference", "", (state.force - force * direction).norm() / force,
                   1e-5, "stiffness within the play, 1e-7 of k");
    const MatrixXd expected = both * direction * direction.transpose() +
                              force / distance * (MatrixXd::Identity(2, 2) - direction * direction.transpose());
    record.at_most("tangent", "", (state.tangent - expected).norm() / expected.norm(), 1e-5,
                   "stiffness within the play, 1e-7 of k");
  }
  // Within the play it moves without force.
  record.at_most("force within the play over k x play", "", law.at(Vector2d(20e-6, 5e-6)).force.norm() / (k * play),
                 1e-6, "stiffness within the play, 1e-7 of k");
}

// Two rows of rollers of each of three planets, on pins that act on each other.
BOOST_AUTO_TEST_CASE(rows_on_a_carrier) {
  annulus::test::Verification record("Bearing in series with what it stands on",
                                     "equilibrium; derivative of the energy");
  const auto stage = stages::reliability_stage(0);
  const MatrixXd pins = pins_stiffness(stages::two_wall_carrier(stage));
  const auto row = law_of(stages::row_of_planets(), Motions::in_space);
  std::vector<SeriesLaw::Part> parts;
  for (Eigen::Index first = 0; first < 15; first += 5) {
    for (const double place : {-0.06, 0.07}) {
      MatrixXd measures = MatrixXd::Zero(row->size(), 15);
      measures.middleCols<5>(first) = to_place(place)(row->coordinates(), Eigen::all);
      parts.push_back({measures, row});
    }
    MatrixXd axial = MatrixXd::Zero(1, 15);
    axial(0, first + 2) = 1;
    parts.push_back({axial, std::make_shared<LinearLaw>(MatrixXd::Constant(1, 1, 1e9))});
  }
  const SeriesLaw law(pins, parts, MatrixXd(0, 15));
  VectorXd d(15);
  for (Eigen::Index i = 0; i < 15; ++i) d[i] = (i % 5 < 3 ? 120e-6 : 4e-4) * std::cos(1.7 * static_cast<double>(i));
  const auto state = law.at(d);
  // What is below gives way by the force over its stiffness; the rest is left to the bearings, which bear that force.
  const VectorXd s = d - pins.ldlt().solve(state.force);
  VectorXd borne = VectorXd::Zero(15);
  for (const auto& part : parts) borne += part.measures.transpose() * part.law->at(part.measures * s).force;
  record.at_most("force of the bearings less that on the pins, over the largest", "",
                 (borne - state.force).cwiseAbs().maxCoeff() / state.force.cwiseAbs().maxCoeff(), 1e-9, "rounding");
  for (Eigen::Index i = 0; i < 15; ++i) {
    const double step = i % 5 < 3 ? 1e-9 : 1e-8;
    VectorXd up = d, down = d;
    up[i] += step;
    down[i] -= step;
    const auto above = law.at(up), under = law.at(down);
    const double slope = (above.energy - under.energy) / (2 * step);
    double largest = 0;  // force or moment
    for (Eigen::Index j = 0; j < 15; ++j)
      if ((j % 5 < 3) == (i % 5 < 3)) largest = std::max(largest, std::abs(state.force[j]));
    record.at_most("derivative of the energy less the force, over the largest of its kind", "",
                   std::abs(slope - state.force[i]) / largest, 1e-4, "central differences");
    const VectorXd column = (above.force - under.force) / (2 * step);
    record.at_most("tangent against differences of the forces, over its column", "",
                   (column - state.tangent.col(i)).norm() / column.norm(), 1e-5, "central differences");
  }
}

BOOST_AUTO_TEST_CASE(linear_parts_and_held_ones) {
  annulus::test::Verification record("Bearing in series with what it stands on", "compliances add up");
  MatrixXd below(3, 3), own(3, 3);
  below << 5, 1, 0.5, 1, 4, -1, 0.5, -1, 6;
  own << 2, 0.3, 0, 0.3, 3, 0.2, 0, 0.2, 1;
  const std::vector<SeriesLaw::Part> parts{{MatrixXd::Identity(3, 3), std::make_shared<LinearLaw>(own)}};
  const VectorXd d = Eigen::Vector3d(0.3, -0.2, 0.5);
  const MatrixXd expected = (below.inverse() + own.inverse()).inverse();
  const SeriesLaw free(below, parts, MatrixXd(0, 3));
  record.at_most("force", "", (free.at(d).force - expected * d).norm(), 1e-13, "rounding");
  record.at_most("stiffness", "", (free.in_contact() - expected).norm(), 1e-13, "rounding");
  const SeriesLaw held(below, parts, MatrixXd::Identity(3, 3));
  record.at_most("force of held bearings less that of what is below", "", (held.at(d).force - below * d).norm(), 1e-13,
                 "rounding");
  BOOST_CHECK_EXCEPTION(
      SeriesLaw(MatrixXd::Zero(3, 3), {}, MatrixXd(0, 3)), annulus::InputError,
      [](const auto& error) { return std::string(error.what()).find("nothing resists") != std::string::npos; });
}

BOOST_AUTO_TEST_SUITE_END()
