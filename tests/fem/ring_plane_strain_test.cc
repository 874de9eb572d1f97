#include <algorithm>
#include <boost/test/unit_test.hpp>
#include <map>

#include "fem/ring/ring_coupling.h"
#include "ring_paper_problems.h"
#include "tests/verification_record.h"

/// Rings solved in the plane against the same rings as solids.
BOOST_AUTO_TEST_SUITE(ring_plane_strain)

using namespace annulus::tests;
using annulus::fem::RingCouplingSettings;
using annulus::fem::solve_ring_coupling;
using annulus::fem::SolvedRingCoupling;

/// A ring on pins of so wide a face, and its modes that move meshes (a solid has others, along its axis), by waves.
struct RingOfWidth {
  RingOfWidth(double width, annulus::fem::RingModel model) {
    auto problem = ring_mesh(paper_pins(24, 0), 2);
    problem.face_width = width;
    RingCouplingSettings settings;
    settings.model = model;
    settings.modes.count = model == annulus::fem::RingModel::solid ? 70 : 8;
    settings.motions = {2, 0};
    solved = solve_ring_coupling(problem, equal_places(5), nominal_load, settings);
    constexpr double at_rest = 0.01;  // kg^-1/2; the others have some tenths
    for (const auto& mode : solved.coupling.modes)
      if (*std::max_element(mode.deflection.begin(), mode.deflection.end()) > at_rest)
        frequency.emplace(mode.waves, mode.frequency);
  }
  SolvedRingCoupling solved;
  std::map<int, double> frequency;  // the lowest one with so many waves
};

BOOST_AUTO_TEST_CASE(plane_strain_is_within_its_stated_error) {
  annulus::test::Verification record("A ring on 24 pins in plane strain",
                                     "the same as a solid, face widths of 2 to 25 modules");
  for (const double modules : {2., 5., 10., 25.}) {
    const double width = modules * 3.8e-3;
    const RingOfWidth plane(width, annulus::fem::RingModel::plane_where_possible),
        solid(width, annulus::fem::RingModel::solid);
    int compared = 0;
    for (const auto& [waves, frequency] : plane.frequency) {
      const auto found = solid.frequency.find(waves);
      if (found == solid.frequency.end()) continue;
      ++compared;
      const double error = frequency / found->second - 1;
      BOOST_TEST_MESSAGE(modules << " modules, " << waves << " waves: plane strain " << 100 * error << " % too high");
      BOOST_TEST(error > 0.01);  // more than the discretisation makes
      record.at_most("frequency of a mode, true over stated error", "", error / plane.solved.frequency_error_relative,
                     1, "stated error");
    }
    BOOST_TEST(compared >= 2);
    record.at_most("coupling, true over stated error", "",
                   (plane.solved.coupling.compliance[0] - solid.solved.coupling.compliance[0]).cwiseAbs().maxCoeff() /
                       (plane.solved.compliance_error + solid.solved.compliance_error),
                   1, "stated errors of both");
  }
}

BOOST_AUTO_TEST_SUITE_END()
