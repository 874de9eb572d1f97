#include <boost/test/unit_test.hpp>
#include <cmath>
#include <memory>
#include <vector>

#include "contact_bench.h"
#include "core/errors.h"
#include "ring_paper_problems.h"
#include "tests/verification_record.h"

/// The loads by which the mesh sees the pressure elements of a flank.
BOOST_AUTO_TEST_SUITE(flank_loads)

using namespace annulus::tests;
using annulus::fem::CondensedBody;
using annulus::fem::FlankLoad;
using annulus::fem::FlankPatch;
using annulus::fem::TraceBasis;

struct Flank {
  const CondensedBody& body;
  double base;
  [[nodiscard]] const TraceBasis& trace() const { return body.body().flank; }
  [[nodiscard]] double arc(double roll) const { return roll * roll / (2 * base); }
  [[nodiscard]] double low() const { return arc(trace().low()); }
  [[nodiscard]] double high() const { return arc(trace().high()); }
  [[nodiscard]] double length() const { return high() - low(); }
  /// Mean length of its cells.
  [[nodiscard]] double cell() const { return length() / trace().elements(); }
};

/// Calls f(flank) for the gears of both meshes in the plane, and of the sun mesh as solids.
template <typename F>
void on_every_flank(const F& f) {
  static const auto benches = [] {
    std::vector<std::unique_ptr<ContactBench>> all;
    all.push_back(std::make_unique<ContactBench>(ring_mesh(annulus::fem::OutsideHeld{}, 2), 0));
    all.push_back(std::make_unique<ContactBench>(sun_mesh(2), 0));
    all.push_back(std::make_unique<ContactBench>(sun_mesh(2), 0, annulus::fem::Fidelity::solid));
    return all;
  }();
  for (const auto& bench : benches) {
    const auto& pair = bench->flanks().pair();
    f(Flank{*bench->bodies().pinion, pair.pinion().base_radius()});
    f(Flank{*bench->bodies().wheel, pair.wheel().base_radius()});
  }
}

/// Elements of some lengths all along a flank, up to a thousandth of it from its ends.
std::vector<FlankLoad> loads_along(const Flank& flank) {
  std::vector<FlankLoad> loads;
  for (const double t : {0.001, 0.01, 0.03, 0.1, 0.27, 0.5, 0.66, 0.9, 0.97, 0.99, 0.999})
    for (const double half : {1e-5, 1e-3, 0.1})
      loads.push_back(
          flank.body.make_load(0, flank.low() + t * flank.length(), std::min({half, t, 1 - t}) * flank.length()));
  return loads;
}

BOOST_AUTO_TEST_CASE(a_load_has_the_resultant_and_the_centre_of_its_element) {
  on_every_flank([](const Flank& flank) {
    FlankPatch patch;
    patch.loads = loads_along(flank);
    flank.body.find_weights(patch, 0);
    for (std::size_t l = 0; l < patch.loads.size(); ++l) {
      const auto column = patch.weights.col(static_cast<Eigen::Index>(l));
      // Shape functions that sum to one to 1e-13 at sixteen points.
      BOOST_TEST(std::abs(column.sum() - 1) < 1e-12);
      double roll = 0, arc = 0, second = 0;
      for (int u = 0; u < flank.trace().size(); ++u) {
        const double r = flank.trace().stations()[u];
        roll += column[u] * r;
        arc += column[u] * flank.arc(r);
        second += column[u] * std::pow(flank.arc(r) - patch.loads[l].arc, 2);
      }
      const FlankLoad& load = patch.loads[l];
      // The roll length is a coordinate that the elements reproduce, the arc is its square, which a quadratic element
      // with a curved coordinate misses by a small part of a cell.
      BOOST_TEST(std::abs(arc - load.arc) < 1e-3 * load.spread + 2e-4 * flank.cell());
      // The second moment of a semi-ellipse is spread^2 / 4: what the mesh gets is as wide as it should be.
      BOOST_TEST(std::abs(second / (load.spread * load.spread / 4) - 1) < 0.01);
      BOOST_TEST(std::abs(roll * roll / (2 * flank.base) - load.arc) < load.spread * load.spread / load.arc);
    }
  });
}

BOOST_AUTO_TEST_CASE(a_load_presses_with_the_lever_arm_of_the_base_circle) {
  annulus::test::Verification record("Loads on flanks", "geometry of the involute: lever arm of the base circle");
  on_every_flank([&](const Flank& flank) {
    FlankPatch patch;
    patch.loads = loads_along(flank);
    for (int l = 0; l < static_cast<int>(patch.loads.size()); ++l)
      for (int s = 0; s < flank.body.slices(); ++s) patch.elements.push_back({l, s});
    flank.body.find_weights(patch, 0);
    for (const int tooth : {0, 3}) {
      const Eigen::MatrixXd resultants = flank.body.resultants(patch, tooth);
      // Positions carry an error of 1e-16 of the radius, sums of some ten.
      record.at_most("lever arm over base radius - 1", "",
                     (resultants.col(2).cwiseAbs().array() / flank.base - 1).abs().maxCoeff(), 1e-12,
                     "rounding of positions, sums of some ten");
      // A load spread along the flank has many directions, whose resultant is shorter: 1 - (turn)^2 / 8. They are
      // interpolated between nodes: a turn of 0.03 to the fourth power.
      const Eigen::VectorXd size = resultants.leftCols(2).rowwise().norm();
      BOOST_TEST(size.maxCoeff() < 1 + 1e-6);
      BOOST_TEST(size.minCoeff() > 0.99);
    }
    const Eigen::MatrixXd ports = flank.body.port_weights(patch);
    BOOST_TEST((ports.colwise().sum().array() - 1).abs().maxCoeff() < 1e-12);
  });
}

BOOST_AUTO_TEST_CASE(the_spread_follows_the_mesh_and_ends_with_the_flank) {
  on_every_flank([](const Flank& flank) {
    for (const bool at_high : {true, false}) {
      double before = 0;
      for (const double t : {1e-6, 1e-4, 1e-3, 3e-3, 0.01}) {
        const double arc = at_high ? flank.high() - t * flank.length() : flank.low() + t * flank.length();
        const FlankLoad load = flank.body.make_load(0, arc, t / 2 * flank.length());
        BOOST_TEST(load.arc == arc);
        BOOST_TEST(load.spread > before);
        before = load.spread;
        // It reaches to the end exactly where the cells are larger than the distance, and never beyond it.
        BOOST_TEST(load.spread <= t * flank.length() * (1 + 1e-9));
      }
      const double nearest = at_high ? flank.high() - 1e-6 * flank.length() : flank.low() + 1e-6 * flank.length();
      BOOST_TEST(flank.body.make_load(0, nearest, 1e-7 * flank.length()).spread < 1.001e-6 * flank.length());
      const double beyond = at_high ? flank.high() + 1e-6 * flank.length() : flank.low() - 1e-6 * flank.length();
      BOOST_CHECK_THROW((void)flank.body.make_load(0, beyond, 1e-7), annulus::InternalError);
    }
    // In the middle a short element gets the width that the mesh resolves, whatever its own; one longer than that
    // keeps its second moment.
    const double middle = (flank.low() + flank.high()) / 2;
    const double resolved = flank.body.make_load(0, middle, 1e-9).spread;
    BOOST_TEST(flank.body.make_load(0, middle, 1e-6).spread == resolved);
    BOOST_TEST(resolved > flank.cell());
    const double longer = 0.999 * std::sqrt(3.0) / 2 * flank.length() / 2;
    BOOST_TEST(flank.body.make_load(0, middle, longer).spread == 2 / std::sqrt(3.0) * longer,
               boost::test_tools::tolerance(1e-9));
  });
}

BOOST_AUTO_TEST_CASE(the_near_field_completes_what_the_mesh_sees) {
  annulus::test::Verification record("Two short pressure elements on a coarse flank",
                                     "half-plane: a logarithm of distance over length");
  on_every_flank([&](const Flank& flank) {
    // Two short elements in the middle of the flank, two of their lengths apart.
    const double middle = (flank.low() + flank.high()) / 2, half = 1e-3 * flank.length();
    FlankPatch patch;
    for (const double arc : {middle - 2 * half, middle + 2 * half})
      patch.loads.push_back(flank.body.make_load(0, arc, half));
    patch.elements = {{0, 0}, {1, 0}};
    flank.body.find_weights(patch, 0);
    const Eigen::MatrixXd mesh = flank.body.compliance(patch, 0, patch, 0), near = flank.body.near_field(patch);
    BOOST_TEST(std::abs(near(0, 1) - near(1, 0)) < 1e-15 * near(0, 0));
    // Both loads nearly coincide on the mesh: it cannot tell their own place from the other's, the sum can.
    const Eigen::MatrixXd whole = mesh + near;
    const double told_by_mesh = (mesh(0, 0) + mesh(1, 1)) / 2 - mesh(0, 1);
    const double told = (whole(0, 0) + whole(1, 1)) / 2 - whole(0, 1);
    BOOST_TEST(told_by_mesh < 0.02 * told);
    // The difference of the two places is that of the half-plane: a logarithm of distance over length.
    const annulus::fem::HalfPlane plane(annulus::fem::Material{});
    const double width = flank.body.slices() > 1 ? 88e-3 / flank.body.slices() : 88e-3;
    const double exact = (plane.strips(0, half, half) - plane.strips(4 * half, half, half)) / width;
    BOOST_TEST_MESSAGE("told apart by the mesh " << told_by_mesh / exact << ", with the near field " << told / exact);
    record.near("difference of their compliances over that of the half-plane", "", told / exact, 1, 0.01,
                "what the coarse mesh adds");
  });
}

BOOST_AUTO_TEST_SUITE_END()
