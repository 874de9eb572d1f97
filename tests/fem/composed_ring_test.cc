#include <Eigen/Core>
#include <algorithm>
#include <boost/test/unit_test.hpp>
#include <cmath>

#include "discretised_body.h"
#include "fem/closed_form/ring_loads.h"
#include "fem/condensation/cyclic_body.h"
#include "structured_mesh.h"
#include "tests/verification_record.h"

/// Plain floating rings composed of finite-element sectors, against the closed forms of rings.
BOOST_AUTO_TEST_SUITE(composed_ring)

using namespace annulus::fem;
using annulus::geometry::Boundary;

const Material unit_material{1.0, 0.3, 1};
constexpr int sectors = 24;

/// A plain ring of unit mean radius and its ports: forces on the nodes of the radial line in the middle of every
/// sector.
struct ComposedRing {
  Eigen::VectorXd weights;  ///< of the nodes: parabolic shear stress over the section, sum 1
  CyclicCompliance compliance;

  /// (radial outwards, tangential) displacement under the same forces `offset` sectors away, each in its own frame.
  [[nodiscard]] Eigen::Matrix2d between(int offset) const {
    const Eigen::MatrixXd block = compliance.block(offset);
    const auto n = weights.size();
    Eigen::Matrix2d result;
    for (int i : {0, 1})
      for (int j : {0, 1}) result(i, j) = weights.dot(block.block(i * n, j * n, n, n) * weights);
    return result;
  }
};

ComposedRing composed_ring(double height, int radial_cells, int angular_cells) {
  const double inner = 1 - height / 2, outer = 1 + height / 2, pitch = 2 * M_PI / sectors;
  const auto mesh =
      annulus::tests::structured_mesh(radial_cells, angular_cells,
                                      [&](double u, double v) -> Eigen::Vector2d {
                                        const double r = inner + (outer - inner) * u, angle = pitch * (v - 0.5);
                                        return {r * std::cos(angle), r * std::sin(angle)};
                                      },
                                      {Boundary::root, Boundary::support, Boundary::side_low, Boundary::side_high});
  const auto project = [&](Boundary boundary, const Eigen::Vector2d& p) -> Eigen::Vector2d {
    if (boundary == Boundary::root) return p * (inner / p.norm());
    return boundary == Boundary::support ? Eigen::Vector2d(p * (outer / p.norm())) : p;
  };
  const auto body = annulus::tests::discretise_body(mesh, project, unit_material, 2);
  SectorModel model;
  model.dimension = 2;
  model.pitch_angle = pitch;
  model.stiffness = body.stiffness;
  model.nodes = body.nodes;
  model.dof = body.dof;
  const auto by_radius = [&](int a, int b) { return body.nodes[a].norm() < body.nodes[b].norm(); };
  model.low_nodes = body.boundary_nodes(Boundary::side_low);
  model.high_nodes = body.boundary_nodes(Boundary::side_high);
  std::sort(model.low_nodes.begin(), model.low_nodes.end(), by_radius);
  std::sort(model.high_nodes.begin(), model.high_nodes.end(), by_radius);

  std::vector<int> line;
  for (std::size_t n = 0; n < body.nodes.size(); ++n)
    if (std::abs(body.nodes[n].y()) < 1e-12) line.push_back(static_cast<int>(n));  // round-off of a unit radius
  std::sort(line.begin(), line.end(), by_radius);
  BOOST_TEST_REQUIRE(line.size() == 2U * radial_cells + 1);
  ComposedRing ring;
  ring.weights.resize(static_cast<Eigen::Index>(line.size()));
  for (std::size_t i = 0; i < line.size(); ++i) {
    const double x = 2 * (body.nodes[line[i]].x() - 1) / height;
    const double simpson = i % 2 == 1 ? 4 : (i == 0 || i + 1 == line.size() ? 1 : 2);
    ring.weights[static_cast<Eigen::Index>(i)] = simpson * (1 - x * x);
  }
  ring.weights /= ring.weights.sum();
  annulus::fem::SectorLoads loads;
  for (const Eigen::Vector3d& direction : {Eigen::Vector3d(1, 0, 0), Eigen::Vector3d(0, 1, 0)})
    for (const int n : line) loads.ports.push_back({n, direction});
  ring.compliance = compose_ring(condense(model, loads, SectorSupport::floating), sectors, {sectors / 2, true},
                                 SectorSupport::floating, 1);
  return ring;
}

BOOST_AUTO_TEST_CASE(equal_radial_loads_on_a_slender_ring) {
  annulus::test::Verification record("Floating ring composed of 24 finite-element sectors, 2 to 6 equal radial loads",
                                     "thin ring of Roark and Timoshenko, extension and shear added");
  const PlaneModuli moduli = plane_strain(unit_material);
  for (const double height : {0.01, 0.02, 0.04}) {
    const ComposedRing ring = composed_ring(height, 4, 64);
    for (const int loads : {2, 3, 4, 6}) {
      double deflection = 0;
      for (int i = 0; i < loads; ++i) deflection += ring.between(i * sectors / loads)(0, 0);
      // Bending of the thin ring (Roark's Formulas for Stress and Strain, rings; Timoshenko), extension and shear
      // added.
      const double theta = M_PI / loads, s = std::sin(theta), c = std::cos(theta);
      const double bending = ((theta + s * c) / (s * s) - 2 / theta) / (4 * moduli.young * std::pow(height, 3) / 12);
      const double extension = (theta + s * c) / (s * s) / (4 * moduli.young * height);
      const double shear = (theta - s * c) / (s * s) / (4 * 5.0 / 6 * moduli.shear * height);
      const double corrected = bending + extension + shear;
      BOOST_TEST_MESSAGE("h/R " << height << ", " << loads << " loads: thin ring " << deflection / bending - 1
                                << ", with extension and shear " << deflection / corrected - 1);
      // The thin ring leaves out that the neutral axis lies inside the middle: Winkler and Bach's R_n^2 h^2 / (12 e) is
      // 1 - 0.23 (h / R)^2. Elements of h/4 in height add 1e-5.
      record.near("deflection under " + std::to_string(loads) + " loads over the closed form", "",
                  deflection / corrected, 1, 0.25 * height * height + 1e-5,
                  "neutral axis inside the middle: 0.23 (h / R)^2; elements 1e-5");
    }
  }
}

BOOST_AUTO_TEST_CASE(a_turn_by_a_sector_changes_nothing_and_the_compliance_is_symmetric) {
  annulus::test::Verification record("Symmetries of a composed ring",
                                     "turns by a sector, mirror image, Maxwell and Betti");
  const ComposedRing ring = composed_ring(0.05, 2, 8);
  // Self-equilibrated loads on three sectors and their mirror images; any place on the ring.
  const auto energy = [&](const std::vector<std::pair<int, Eigen::Vector2d>>& forces) {
    double sum = 0;
    for (const auto& [i, f] : forces)
      for (const auto& [j, g] : forces) sum += f.dot(ring.between(i - j) * g);
    return sum;
  };
  const auto at = [](int sector, double radial, double tangential) {
    return std::pair(sector, Eigen::Vector2d(radial, tangential));
  };
  const double opposite = energy({at(0, 1, 0), at(12, 1, 0)});
  for (int turned = 1; turned < sectors; ++turned)
    record.close("energy of two opposite forces, turned", "J", energy({at(turned, 1, 0), at(turned + 12, 1, 0)}),
                 opposite, 1e-12, "rounding");
  // Three sectors pulled and turned, three others that hold them; and the mirror image.
  const double one =
      energy({at(0, 1, 0.5), at(8, 1, 0.5), at(16, 1, 0.5), at(4, 0, -0.5), at(12, 0, -0.5), at(20, 0, -0.5)});
  const double other =
      energy({at(0, 1, -0.5), at(16, 1, -0.5), at(8, 1, -0.5), at(20, 0, 0.5), at(12, 0, 0.5), at(4, 0, 0.5)});
  record.close("energy of six forces and of their mirror image", "J", one, other, 1e-9,
               "rounding x stiffness ratio (R / h)^3");
  for (int offset = 0; offset <= sectors / 2; ++offset) {
    const Eigen::Matrix2d there = ring.between(offset), back = ring.between(-offset);
    record.at_most("asymmetry of the compliance over its norm", "",
                   (there - back.transpose()).norm() / ring.between(0).norm(), 1e-10, "rounding");
    // Mirror image: radial and tangential couple antisymmetrically.
    BOOST_TEST(std::abs(there(0, 1) + back(0, 1)) < 1e-8 * ring.between(0).norm());
  }
}

BOOST_AUTO_TEST_CASE(thick_rings_follow_elasticity_and_leave_the_beam) {
  annulus::test::Verification record("Thick ring composed of finite-element sectors",
                                     "Fourier series of plane elasticity (Michell); the curved beam for comparison");
  annulus::test::RecordedPlot::Curve elastic_curve{"plane elasticity", {}, {}, {}},
      beam_curve{"curved beam", {}, {}, {}};
  const PlaneModuli moduli = plane_strain(unit_material);
  double departure = 0;
  for (const double height : {0.05, 0.1, 0.2, 0.4}) {
    const ComposedRing ring = composed_ring(height, 8, 16);
    const PlainRing plain{1 - height / 2, 1 + height / 2, moduli};
    // Four radial forces on the inner circle; radial displacement of the outer circle half-way between them.
    double finite = 0;
    for (int i = 0; i < 4; ++i) finite += ring.compliance.block(6 * i + 3)(ring.weights.size() - 1, 0);
    constexpr int most = 4000;
    const auto closed = [&](const RingSeries& series) {
      const auto coupling = series.coupling(radial_force(Circle::outer, 0, Spread::uniform, most),
                                            radial_force(Circle::inner, 0, Spread::uniform, most));
      double sum = 0;
      for (int i = 0; i < 4; ++i) sum += coupling(2 * M_PI * (6 * i + 3) / sectors);
      return sum;
    };
    const double elastic = closed({[&](int n) { return elastic_ring(plain, n, HeldCircle::none); }, most});
    const double beam = closed({[&](int n) { return curved_beam(plain, n); }, most});
    BOOST_TEST_MESSAGE("h/R " << height << ": elasticity " << elastic / finite - 1 << ", curved beam "
                              << beam / finite - 1);
    // Quadratic elements of height h/8; in the thick ring the two circles are but two waves of its loads apart, and the
    // displacement is a small difference.
    record.close("deflection by finite elements x E, h/R " + std::to_string(height).substr(0, 4), "m", finite, elastic,
                 1e-3, "quadratic elements of h/8");
    elastic_curve.x.push_back(height);
    elastic_curve.computed.push_back(elastic / finite - 1);
    beam_curve.x.push_back(height);
    beam_curve.computed.push_back(beam / finite - 1);
    BOOST_TEST(std::abs(beam / finite - 1) > departure);
    departure = std::abs(beam / finite - 1);
  }
  BOOST_TEST(departure > 0.02);
  record.plot({"Departure from finite elements", "height over radius", "", {elastic_curve, beam_curve}});
}

BOOST_AUTO_TEST_SUITE_END()
