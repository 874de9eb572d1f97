#include <Eigen/Core>
#include <algorithm>
#include <boost/test/unit_test.hpp>
#include <cmath>
#include <numeric>

#include "core/errors.h"
#include "fem/loaded_mesh.h"
#include "ring_paper_problems.h"
#include "tests/verification_record.h"

/// Strain gauges on the ring paper's ring.
BOOST_AUTO_TEST_SUITE(strain_gauge)

using namespace annulus::tests;
using annulus::fem::Fidelity;
using annulus::fem::GaugeHistory;
using annulus::fem::LoadedMeshProblem;
using annulus::fem::LoadedMeshResult;
using annulus::fem::LoadedMeshSettings;
using annulus::fem::StrainGauge;
using Place = StrainGauge::Place;

constexpr double first_pin = 0.03;  // rad: no symmetry with the teeth
constexpr double mm = 1e-3;

StrainGauge outside_gauge(double angle, double length) {
  StrainGauge gauge;
  gauge.name = "outside";
  gauge.place = Place::outside;
  gauge.angle = angle;
  gauge.length = length;
  return gauge;
}
StrainGauge root_gauge(double angle, double offset, double length) {
  StrainGauge gauge = outside_gauge(angle, length);
  gauge.name = "root";
  gauge.place = Place::root;
  gauge.offset = offset;
  return gauge;
}

LoadedMeshResult solved(const LoadedMeshProblem& problem, Fidelity fidelity = Fidelity::plane, int level = 1) {
  LoadedMeshSettings settings;
  settings.fidelity = fidelity;
  settings.level = level;
  settings.threads = 2;
  settings.recovery = annulus::fem::Recovery::fields;
  return solve_loaded_mesh(problem, settings);
}

/// Where a history has the pitch point of a position.
std::size_t index_of(const GaugeHistory& history, double ring_angle) {
  const auto off = [&](double angle) { return std::abs(std::remainder(angle - ring_angle, 2 * M_PI)); };
  const auto found =
      std::min_element(history.angle.begin(), history.angle.end(), [&](double a, double b) { return off(a) < off(b); });
  BOOST_TEST(off(*found) < 1e-9);
  return static_cast<std::size_t>(found - history.angle.begin());
}

double largest(const std::vector<double>& values) { return *std::max_element(values.begin(), values.end()); }
double largest_size(const std::vector<double>& values) {
  return std::max(largest(values), -*std::min_element(values.begin(), values.end()));
}

/// Strain of a free surface in plane strain, per Pa of the tangential stress.
double compliance(const LoadedMeshProblem& problem) {
  const auto& m = problem.materials.wheel;
  return (1 - m.poisson_ratio * m.poisson_ratio) / m.youngs_modulus;
}

BOOST_AUTO_TEST_CASE(a_short_gauge_shows_the_stress_of_its_place) {
  annulus::test::Verification record("Strain of short gauges on a ring on 18 pins",
                                     "plane strain: (1 - nu^2)/E times the recovered stress of the same place");
  auto problem = ring_mesh(paper_pins(18, first_pin), 4);
  const auto without = solved(problem);
  using Along = annulus::fem::StressCurve::Along;
  const auto curve = [&](Along along) {
    const auto found = std::find_if(without.stress_curves.begin(), without.stress_curves.end(), [&](const auto& c) {
      return c.body == annulus::geometry::GearRole::wheel && c.along == along;
    });
    BOOST_REQUIRE(found != without.stress_curves.end());
    return *found;
  };
  const auto rim = curve(Along::rim), root = curve(Along::root);
  // Points of the curves, on either side of their peaks.
  const auto peak = [](const annulus::fem::StressCurve& c) {
    return std::max_element(c.von_mises.begin(), c.von_mises.end()) - c.von_mises.begin();
  };
  const double length = 1e-6 * mm, middle = root.abscissa.back() / 2;
  std::vector<std::ptrdiff_t> on_rim, on_root;
  for (const int beside : {-60, -7, 0, 9, 300}) {
    const auto i = (peak(rim) + beside + static_cast<std::ptrdiff_t>(rim.abscissa.size())) %
                   static_cast<std::ptrdiff_t>(rim.abscissa.size());
    on_rim.push_back(i);
    problem.gauges.push_back(outside_gauge(rim.abscissa[i], length));
  }
  // The curve belongs to one of the tooth spaces after which the ring repeats.
  const int repeating = problem.structure.repeating_teeth(problem.pair.wheel().teeth());
  for (const int beside : {-3, 0, 4}) {
    on_root.push_back(peak(root) + beside);
    for (int space = 0; space < repeating; ++space)
      problem.gauges.push_back(root_gauge((space + 0.5) * problem.pair.wheel().pitch_angle(),
                                          root.abscissa[on_root.back()] - middle, length));
  }
  const auto result = solved(problem);
  const double scale = compliance(problem) * largest_size(rim.tangential);
  for (std::size_t g = 0; g < on_rim.size(); ++g) {
    const auto& history = result.gauges[g];
    const double strain = history.strain[index_of(history, without.positions[rim.position].ring_angle)];
    record.near("strain on the outside", "", strain, compliance(problem) * rim.tangential[on_rim[g]], 2e-3 * scale,
                "stress between the points of the curve is linear, the gauge stands on one");
  }
  for (std::size_t g = 0; g < on_root.size(); ++g) {
    const double expected = compliance(problem) * root.tangential[on_root[g]];
    double closest = 0;
    for (int space = 0; space < repeating; ++space)
      for (const double strain : result.gauges[on_rim.size() + g * repeating + space].strain)
        if (std::abs(strain - expected) < std::abs(closest - expected)) closest = strain;
    record.near("strain in the root", "", closest, expected, 1e-5 * std::abs(expected), "the same place and load");
  }
  // The table does not change because somebody looks.
  record.close("mean stiffness with and without gauges", "N/m", result.table.at(0, 0, 0).stiffness_secant,
               without.table.at(0, 0, 0).stiffness_secant, 1e-12, "the same solve");
}

BOOST_AUTO_TEST_CASE(a_long_gauge_shows_how_far_its_ends_move_apart) {
  annulus::test::Verification record("Strain of long gauges on a ring on 18 pins",
                                     "elongation of the surface by the displacements of its points");
  auto problem = ring_mesh(paper_pins(18, first_pin), 4);
  const auto without = solved(problem);
  const auto& field = *std::find_if(without.fields.begin(), without.fields.end(),
                                    [](const auto& f) { return f.body == annulus::geometry::GearRole::wheel; });
  // Vertices on the outside, by their angle.
  struct Point {
    double angle;
    Eigen::Vector2d at, moved;
  };
  std::vector<Point> outside;
  for (std::size_t v = 0; v < field.displacement.size(); ++v) {
    const Eigen::Vector2d at = field.mesh.vertices[v].head<2>();
    if (std::abs(at.norm() - ring_outside) < 1e-6 * ring_outside)
      outside.push_back({std::atan2(at.y(), at.x()), at, field.displacement[v].head<2>()});
  }
  std::sort(outside.begin(), outside.end(), [](const auto& a, const auto& b) { return a.angle < b.angle; });
  outside.erase(std::unique(outside.begin(), outside.end(),
                            [](const auto& a, const auto& b) { return b.angle - a.angle < 1e-9; }),
                outside.end());
  BOOST_TEST(outside.size() > 200U);
  const double ring_angle = without.positions[field.position].ring_angle;
  // Between two of these vertices some degrees apart, at the contact and away from it.
  std::vector<double> expected;
  for (const double from : {-0.12, -0.03, 0.05, 0.4, 2.0}) {
    const double start = std::remainder(ring_angle + from, 2 * M_PI);
    const auto first = std::lower_bound(outside.begin(), outside.end(), start,
                                        [](const auto& p, double angle) { return p.angle < angle; });
    auto i = first - outside.begin();
    const auto count = static_cast<std::ptrdiff_t>(outside.size());
    double length = 0, elongation = 0;
    const double begin = outside[i % count].angle;
    double end = begin;
    while (end - begin < 0.06) {
      const auto &a = outside[i % count], &b = outside[(i + 1) % count];
      const Eigen::Vector2d chord = b.at - a.at;
      elongation += (b.moved - a.moved).dot(chord.normalized());
      length += chord.norm();
      end += std::remainder(b.angle - a.angle, 2 * M_PI);
      ++i;
    }
    expected.push_back(elongation / length);
    problem.gauges.push_back(outside_gauge((begin + end) / 2, ring_outside * (end - begin)));
  }
  const auto result = solved(problem);
  const double scale = largest_size(expected);
  for (std::size_t g = 0; g < expected.size(); ++g)
    record.near("mean strain", "", result.gauges[g].strain[index_of(result.gauges[g], ring_angle)], expected[g],
                0.03 * scale, "stresses at vertices are those of the first level, and pins press between them");
}

BOOST_AUTO_TEST_CASE(a_ring_that_repeats_is_continued_around) {
  annulus::test::Verification record("Gauges on a ring that repeats after 9 of 81 teeth",
                                     "the same 18 pins, every one of the 81 positions solved");
  auto problem = ring_mesh(paper_pins(18, first_pin), 2);
  const double pitch = problem.pair.wheel().pitch_angle();
  problem.gauges = {outside_gauge(0.7, 2 * mm), root_gauge(2.3, 0.5 * mm, mm), outside_gauge(0.7 + 9 * pitch, 2 * mm)};
  auto listed = problem;
  auto pins = paper_pins(18, first_pin);
  pins.angles[5] += 1e-9;  // no longer equal, by nothing that matters
  listed.structure = pins;
  const auto repeated = solved(problem), all = solved(listed);
  BOOST_TEST(repeated.positions.size() < all.positions.size());
  for (std::size_t g = 0; g < problem.gauges.size(); ++g) {
    const auto &a = repeated.gauges[g], &b = all.gauges[g];
    BOOST_REQUIRE(a.strain.size() == b.strain.size());
    double worst = 0, turned = 0;
    for (std::size_t i = 0; i < a.strain.size(); ++i) {
      worst = std::max(worst, std::abs(a.strain[i] - b.strain[i]));
      turned = std::max(turned, std::abs(a.angle[i] - b.angle[i]));
    }
    record.at_most("difference of a strain over the largest", "", worst / largest_size(b.strain), 1e-5,
                   "pins moved by 1e-9 rad");
    record.at_most("difference of the angle of the mesh", "rad", turned, 1e-9, "rounding");
  }
  // Turned by as many teeth as the ring repeats after, the gauge shows the same that much later.
  const auto &here = repeated.gauges[0], &there = repeated.gauges[2];
  double worst = 0;
  for (std::size_t i = 0; i < here.strain.size(); ++i) {
    const double angle = here.angle[i] + 9 * pitch;
    worst = std::max(worst, std::abs(here.strain[i] - there.strain[index_of(there, angle)]));
  }
  record.at_most("difference of a gauge 9 teeth further, over the largest", "", worst / largest_size(here.strain), 1e-9,
                 "symmetry");
}

BOOST_AUTO_TEST_CASE(gauges_across_a_solid_face) {
  annulus::test::Verification record("Root gauges across the face of a solid ring",
                                     "its plane section, and the load over the face width");
  auto problem = ring_mesh(annulus::fem::OutsideHeld{}, 4);
  const double width = problem.face_width, space = problem.pair.wheel().pitch_angle() / 2;
  const auto at = [&](double part, StrainGauge::Direction direction = StrainGauge::Direction::hoop) {
    auto gauge = root_gauge(space, 0, mm);
    gauge.z = part * width;
    gauge.direction = direction;
    return gauge;
  };
  auto plane = problem;
  auto in_fillet = at(0.5);
  in_fillet.offset = 1.1 * mm;
  in_fillet.length = 0.5 * mm;
  plane.gauges = {at(0), in_fillet};
  const auto section = solved(plane, Fidelity::plane, 3);
  problem.gauges = {at(0.5), at(0.2), at(0.8), at(0.5, StrainGauge::Direction::axial), in_fillet};
  const auto even = solved(problem, Fidelity::solid, 1);
  const auto over_plane = [&](std::size_t of_solid, std::size_t of_plane) {
    return largest_size(even.gauges[of_solid].strain) / largest_size(section.gauges[of_plane].strain);
  };
  const char* origin = "cells of the first level; a face 23 modules wide is near plane strain";
  record.near("largest strain of the root land in the middle over that of the plane section", "", over_plane(0, 0), 1,
              0.03, origin);
  record.near("the same in the fillet", "", over_plane(4, 1), 1, 0.05, origin);
  record.close("strains at equal distances from the middle", "", largest(even.gauges[1].strain),
               largest(even.gauges[2].strain), 1e-9, "solved on half of the face");
  record.at_most("axial strain in the middle over the hoop strain", "",
                 largest_size(even.gauges[3].strain) / largest_size(even.gauges[0].strain), 0.1,
                 "wide faces are near plane strain");
  problem.misalignment = 20e-6;
  const auto tilted = solved(problem, Fidelity::solid, 1);
  const double low = largest(tilted.gauges[1].strain), high = largest(tilted.gauges[2].strain);
  record.at_least("strain at the loaded end over that at the other one", "", low / high, 1.2,
                  "the flanks open towards +z");
}

BOOST_AUTO_TEST_CASE(what_has_no_place_is_refused) {
  const auto message = [](const LoadedMeshProblem& problem, Fidelity fidelity = Fidelity::plane) -> std::string {
    try {
      (void)solved(problem, fidelity);
    } catch (const annulus::InputError& error) {
      return error.what();
    }
    return "";
  };
  auto problem = ring_mesh(annulus::fem::OutsideHeld{}, 2);
  problem.gauges = {outside_gauge(0, mm)};
  BOOST_TEST(message(problem).find("held there") != std::string::npos);
  problem.gauges = {root_gauge(0, 20 * mm, mm)};
  BOOST_TEST(message(problem).find("does not lie in its root") != std::string::npos);
  problem.gauges = {root_gauge(0, 0, mm)};
  BOOST_TEST(message(problem, Fidelity::closed_form).find("whole body") != std::string::npos);
  problem.gauges.front().z = 1.5 * problem.face_width;
  BOOST_TEST(message(problem, Fidelity::solid).find("has no surface") != std::string::npos);
  problem.gauges.front().direction = StrainGauge::Direction::axial;
  BOOST_TEST(message(problem).find("along the axis") != std::string::npos);
}

BOOST_AUTO_TEST_SUITE_END()
