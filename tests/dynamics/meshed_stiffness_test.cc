#include "dynamics/statics/meshed_stiffness.h"

#include <boost/test/unit_test.hpp>
#include <random>

#include "tests/verification_record.h"

BOOST_AUTO_TEST_SUITE(meshed_stiffness)

using annulus::dynamics::MeshedStiffness;

/// Supports of most coordinates and meshes between all, from 1e8 to 1e9 N/m.
struct Example {
  static constexpr int dofs = 24, meshes = 10;
  std::mt19937 random{3};
  Eigen::MatrixXd stiffness = Eigen::MatrixXd::Zero(dofs, dofs), vectors{dofs, meshes}, force{dofs, 2};
  Eigen::VectorXd mean{meshes};

  double number(double low, double high) { return std::uniform_real_distribution(low, high)(random); }
  Example() {
    for (int i = 0; i < dofs - 8; ++i) stiffness(i, i) = number(1e8, 1e9);  // the last eight by meshes alone
    for (double& x : vectors.reshaped()) x = number(-1, 1);
    for (double& x : force.reshaped()) x = number(-1e4, 1e4);
    for (double& k : mean) k = number(5e8, 1e9);
  }
  /// Of coupled meshes.
  Eigen::MatrixXd tangent() {
    Eigen::MatrixXd compliance = (mean.cwiseInverse() * number(0.7, 1.4)).asDiagonal();
    for (int i = 0; i < meshes; ++i)
      for (int j = 0; j < i; ++j) compliance(i, j) = compliance(j, i) = number(-5e-11, 5e-11);
    return compliance.inverse();
  }
  [[nodiscard]] Eigen::MatrixXd expected(const Eigen::MatrixXd& tangent) const {
    return (stiffness + vectors * tangent * vectors.transpose()).fullPivLu().solve(force);
  }
};

BOOST_AUTO_TEST_CASE(many_tangents) {
  annulus::test::Verification record("Stiffness with many tangents of meshes", "the whole matrix, by elimination");
  Example example;
  MeshedStiffness stiffness(example.stiffness, example.vectors, example.mean);
  const auto compare = [&](const char* what, const Eigen::MatrixXd& tangent) {
    BOOST_REQUIRE(stiffness.factorise(tangent));
    const auto expected = example.expected(tangent);
    record.at_most(what, "", (stiffness.solve(example.force) - expected).norm() / expected.norm(), 1e-11,
                   "rounding times the condition of the matrix");
  };
  for (int i = 0; i < 5; ++i) compare("displacements, coupled meshes", example.tangent());
  Eigen::MatrixXd open = example.mean.asDiagonal();
  open(3, 3) *= 1e-3;
  compare("displacements, an open mesh", open);
  compare("displacements, closed again", example.tangent());
  example.vectors *= 1.1;
  stiffness.set_vectors(example.vectors);
  compare("displacements, other mesh vectors", example.tangent());
}

BOOST_AUTO_TEST_CASE(tangents_that_are_not_positive) {
  Example example;
  MeshedStiffness stiffness(example.stiffness, example.vectors, example.mean);
  Eigen::MatrixXd tangent = example.mean.asDiagonal();
  BOOST_TEST(stiffness.factorise(tangent));
  tangent(0, 1) = tangent(1, 0) = -3e9;  // subtracts more than both have
  BOOST_TEST(!stiffness.factorise(tangent));
  tangent = -1e3 * example.mean.asDiagonal().toDenseMatrix();
  BOOST_TEST(!stiffness.factorise(tangent));
}

BOOST_AUTO_TEST_SUITE_END()
