#include "dynamics/spatial/carrier_structure.h"

#include <Eigen/Dense>
#include <boost/test/unit_test.hpp>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

#include "core/errors.h"
#include "dynamics/spatial/elastic_laws.h"
#include "tests/dynamics/spatial_stages.h"
#include "tests/verification_record.h"

BOOST_AUTO_TEST_SUITE(carrier_structure)

using namespace annulus::dynamics;
using annulus::Beam;

namespace {

/// A frame of Timoshenko beams along z in finite elements, six unknowns per node (x, y, z, about x, y, z). Nodes of one
/// wall are those of one rigid body.
class Frame {
 public:
  int add_free_node() {
    nodes_.push_back({unknowns_, {0, 0, 0}});
    unknowns_ += 6;
    return static_cast<int>(nodes_.size()) - 1;
  }
  int add_rigid_body() { return std::exchange(unknowns_, unknowns_ + 6); }
  /// A node of a rigid body, at a point from its middle; body -1 stands still.
  int add_node_of(int body, const Eigen::Vector3d& point) {
    nodes_.push_back({body, point});
    return static_cast<int>(nodes_.size()) - 1;
  }
  /// Between nodes at z and z + length; axes: two bending directions, as columns.
  void add_beam(int low, int high, double length, const Beam& first, const Beam& second, double angle) {
    beams_.push_back({low, high, length, first, second, angle});
  }
  [[nodiscard]] Eigen::MatrixXd stiffness() const {
    Eigen::MatrixXd all = Eigen::MatrixXd::Zero(unknowns_, unknowns_);
    for (const auto& beam : beams_) {
      Eigen::MatrixXd motions(12, unknowns_);
      motions << motion(beam.low), motion(beam.high);
      all += motions.transpose() * element(beam) * motions;
    }
    return all;
  }
  [[nodiscard]] Eigen::MatrixXd motion(int node) const {
    const auto& n = nodes_[static_cast<std::size_t>(node)];
    Eigen::MatrixXd result = Eigen::MatrixXd::Zero(6, unknowns_);
    if (n.first < 0) return result;
    result.middleCols<6>(n.first).setIdentity();
    const auto& p = n.point;
    Eigen::Matrix3d cross;  // phi x p
    cross << 0, p.z(), -p.y(), -p.z(), 0, p.x(), p.y(), -p.x(), 0;
    result.block<3, 3>(0, n.first + 3) = cross;
    return result;
  }

 private:
  struct Node {
    int first = 0;  ///< unknown; of a free node its own
    Eigen::Vector3d point;
  };
  struct Element {
    int low = 0, high = 0;
    double length = 0;
    Beam first, second;
    double angle = 0;
  };
  static Eigen::MatrixXd element(const Element& e) {
    Eigen::MatrixXd k = Eigen::MatrixXd::Zero(12, 12);
    const double l = e.length;
    const auto pair = [&](int a, double stiffness) {
      k(a, a) += stiffness;
      k(a + 6, a + 6) += stiffness;
      k(a, a + 6) -= stiffness;
      k(a + 6, a) -= stiffness;
    };
    pair(2, e.first.axial / l);
    pair(5, e.first.torsion / l);
    // Hermite polynomials with shear; the slope of x over z is a rotation about +y, that of y one about -x.
    for (const auto& [beam, shift, turn, sign] : {std::tuple{&e.first, 0, 4, 1.0}, {&e.second, 1, 3, -1.0}}) {
      const double phi = 12 * beam->bending / (beam->shear * l * l), c = beam->bending / (std::pow(l, 3) * (1 + phi));
      Eigen::Matrix4d bend;
      bend << 12, 6 * l, -12, 6 * l, 6 * l, (4 + phi) * l * l, -6 * l, (2 - phi) * l * l, -12, -6 * l, 12, -6 * l,
          6 * l, (2 - phi) * l * l, -6 * l, (4 + phi) * l * l;
      const int at[] = {shift, turn, shift + 6, turn + 6};
      const double signs[] = {1, sign, 1, sign};
      for (int i = 0; i < 4; ++i)
        for (int j = 0; j < 4; ++j) k(at[i], at[j]) += c * signs[i] * signs[j] * bend(i, j);
    }
    Eigen::MatrixXd axes = Eigen::MatrixXd::Zero(12, 12);
    const double c = std::cos(e.angle), s = std::sin(e.angle);
    for (int i = 0; i < 4; ++i) axes.block<3, 3>(3 * i, 3 * i) << c, s, 0, -s, c, 0, 0, 0, 1;
    return axes.transpose() * k * axes;
  }

  std::vector<Node> nodes_;
  std::vector<Element> beams_;
  int unknowns_ = 0;
};

/// The stiffness of the pins, from a frame with several elements per beam.
Eigen::MatrixXd by_frame(const TwoWallCarrier& c) {
  constexpr int parts = 6;  // of a beam
  Frame frame;
  const int far = frame.add_rigid_body();
  const double side = c.shaft == Side::low ? 1 : -1;
  // From the wall at -z to that at +z.
  const auto beam = [&](double angle, double radius, double length, const Beam& radial, const Beam& tangential) {
    std::vector<int> nodes;
    for (int i = 0; i <= parts; ++i) {
      const double z = length * (static_cast<double>(i) / parts - 0.5);
      const Eigen::Vector3d point(radius * std::cos(angle), radius * std::sin(angle), z);
      const bool end = i == 0 || i == parts;
      nodes.push_back(!end ? frame.add_free_node() : frame.add_node_of(side * z > 0 ? far : -1, point));
      if (i > 0) frame.add_beam(nodes[nodes.size() - 2], nodes.back(), length / parts, radial, tangential, angle);
    }
    return nodes[parts / 2];
  };
  std::vector<int> middles;
  for (const double angle : c.planet_angles) middles.push_back(beam(angle, c.radius, c.pin_length, c.pin, c.pin));
  for (int k = 0; k < c.webs; ++k)
    beam(c.first_web + 2 * std::numbers::pi * k / c.webs, c.web_radius, c.web_length,
         annulus::rectangular_beam(c.web_depth, c.web_width, c.youngs_modulus, c.poisson_ratio),
         annulus::rectangular_beam(c.web_width, c.web_depth, c.youngs_modulus, c.poisson_ratio));
  const Eigen::MatrixXd stiffness = frame.stiffness();
  Eigen::MatrixXd motions(5 * std::ssize(middles), stiffness.rows());
  for (std::size_t n = 0; n < middles.size(); ++n) {
    const double phi = c.planet_angles[n];
    Eigen::Matrix<double, 6, 6> axes = Eigen::Matrix<double, 6, 6>::Zero();
    for (const int i : {0, 3})
      axes.block<3, 3>(i, i) << std::cos(phi), std::sin(phi), 0, -std::sin(phi), std::cos(phi), 0, 0, 0, 1;
    motions.middleRows<5>(static_cast<Eigen::Index>(5 * n)) = (axes * frame.motion(middles[n])).topRows<5>();
  }
  return (motions * stiffness.ldlt().solve(motions.transpose())).inverse();
}

TwoWallCarrier carrier(Side shaft = Side::low) {
  auto result = stages::two_wall_carrier(stages::reliability_stage(0));
  result.shaft = shaft;
  return result;
}

double difference(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b) {
  const Eigen::VectorXd scale = b.diagonal().cwiseSqrt().cwiseInverse();
  return (scale.asDiagonal() * (a - b) * scale.asDiagonal()).cwiseAbs().maxCoeff();
}

}  // namespace

BOOST_AUTO_TEST_CASE(two_walls_and_webs) {
  annulus::test::Verification record("Carrier of two walls and webs",
                                     "frame of beams in finite elements; closed forms");
  for (const auto shaft : {Side::low, Side::high}) {
    record.at_most("difference of the stiffness matrices, shaft on either side", "",
                   difference(pins_stiffness(carrier(shaft)), by_frame(carrier(shaft))), 1e-7, "rounding of the frame");
    auto uneven = carrier(shaft);
    uneven.planet_angles = {0.1, 1.9, 4.2, 5.0};
    uneven.webs = 2;
    record.at_most("the same, four uneven planets and two webs", "",
                   difference(pins_stiffness(uneven), by_frame(uneven)), 1e-7, "rounding of the frame");
  }
  // Rigid webs: pins in rigid walls.
  auto stiff = carrier();
  stiff.youngs_modulus *= 1e9;
  const auto beam = stiff.pin;
  const EndStiffness walls =
      beam_end(beam, beam, stiff.pin_length / 2, Side::low) + beam_end(beam, beam, stiff.pin_length / 2, Side::high);
  record.at_most("rigid webs beside pins in rigid walls", "",
                 difference(pins_stiffness(stiff), stages::on_each_planet(stages::reliability_stage(0), walls)), 1e-7,
                 "stiffness of the webs");
  record.close("pin between walls", "N/m", walls(0, 0), 2 / beam.parallel_shift(stiff.pin_length / 2), 1e-12,
               "rounding");
  // Pins that are soft beside the webs: half of the torque passes through these.
  auto soft = carrier();
  for (double* property : {&soft.pin.bending, &soft.pin.shear, &soft.pin.axial, &soft.pin.torsion}) *property *= 1e-6;
  const auto web = annulus::rectangular_beam(soft.web_width, soft.web_depth, soft.youngs_modulus, soft.poisson_ratio);
  const double twist_stiffness = soft.webs * (soft.web_radius * soft.web_radius / web.parallel_shift(soft.web_length) +
                                              web.torsion / soft.web_length);
  const double force = 1e5, torque = 3 * force * soft.radius;
  Eigen::VectorXd load = Eigen::VectorXd::Zero(15);
  for (const Eigen::Index n : {1, 6, 11}) load[n] = force;
  const Eigen::VectorXd motion = pins_stiffness(soft).ldlt().solve(load);
  const double own = force * soft.pin.parallel_shift(soft.pin_length / 2) / 2;
  record.close("wind-up of the webs", "m", motion[1] - own, soft.radius * torque / 2 / twist_stiffness / 2, 1e-5,
               "stiffness of the pins; difference of large numbers");
}

BOOST_AUTO_TEST_CASE(carriers_that_are_refused) {
  const auto refused = [](auto change, const std::string& text) {
    auto c = carrier();
    change(c);
    BOOST_CHECK_EXCEPTION((void)pins_stiffness(c), annulus::InputError,
                          [&](const auto& error) { return std::string(error.what()).find(text) != std::string::npos; });
  };
  refused([](auto& c) { c.webs = 1; }, "two webs");
  refused([](auto& c) { c.web_depth = 0; }, "depth of the webs");
  refused([](auto& c) { c.pin_length = -1; }, "length of the pins");
}

BOOST_AUTO_TEST_SUITE_END()
