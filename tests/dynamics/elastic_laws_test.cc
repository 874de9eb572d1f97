#include <Eigen/Dense>
#include <boost/test/unit_test.hpp>
#include <cmath>
#include <memory>
#include <vector>

#include "core/errors.h"
#include "dynamics/spatial/coupled_faces.h"
#include "dynamics/spatial/elastic_laws.h"
#include "dynamics/spatial/even_face.h"
#include "tests/dynamics/law_slopes.h"
#include "tests/verification_record.h"

BOOST_AUTO_TEST_SUITE(elastic_laws)

using namespace annulus::dynamics;
using annulus::ElasticLaw;

// The step of the differences leaves its square over that of the deflection, and rounding over the step.
BOOST_AUTO_TEST_CASE(force_and_tangent_belong_to_the_energy) {
  annulus::test::Verification record("Elastic laws in space", "differences of the energy and of the force");
  Eigen::MatrixXd k(3, 3);
  k << 4e8, 1e7, -2e6, 1e7, 3e8, 5e6, -2e6, 5e6, 1e6;
  const std::vector<double> stations{-0.1, -0.03, 0.05, 0.1}, gap{3e-6, 0, 1e-6, 8e-6};
  std::vector<std::pair<std::unique_ptr<ElasticLaw>, std::vector<double>>> laws;
  laws.emplace_back(std::make_unique<LinearLaw>(k), std::vector<double>{3e-5, -2e-5, 4e-4});
  laws.emplace_back(std::make_unique<StopLaw>(2, 1e9, 2e-5), std::vector<double>{3e-5, -2e-5});
  laws.emplace_back(std::make_unique<StopLaw>(1, 1e9, 2e-5), std::vector<double>{-3e-5});
  laws.emplace_back(std::make_unique<LoadZoneLaw>(annulus::RadialBearing(1e9, 2e-5, 3e9), 1e9),
                    std::vector<double>{3e-5, -2e-5});
  laws.emplace_back(std::make_unique<EvenFace>(2e9, stations, gap), std::vector<double>{2e-5, 1e-5, -1e-5, 2e-5});
  laws.emplace_back(std::make_unique<EvenFace>(2e9, stations, gap), std::vector<double>{-2e-5, -1e-5, 3e-5, 2e-5});
  laws.emplace_back(std::make_unique<TableLaw>(std::vector<double>{1e-5, 2e-5, 5e-5}, std::vector<double>{0, 1e4, 8e4}),
                    std::vector<double>{3e-5, -2e-5});
  laws.emplace_back(std::make_unique<TableLaw>(std::vector<double>{0, 2e-5}, std::vector<double>{0, 1e4}),
                    std::vector<double>{3e-5, -2e-5});
  annulus::test::LawSlopes worst;
  for (const auto& [law, at] : laws) {
    const Eigen::VectorXd point = Eigen::Map<const Eigen::VectorXd>(at.data(), std::ssize(at));
    const auto found = annulus::test::law_slopes(*law, point, 1e-9);
    worst.force = std::max(worst.force, found.force);
    worst.tangent = std::max(worst.tangent, found.tangent);
    BOOST_TEST(law->in_contact().rows() == law->size());
  }
  record.at_most("force, largest relative difference", "", worst.force, 1e-7, "step of the differences");
  record.at_most("tangent, largest relative difference", "", worst.tangent, 1e-7, "step of the differences");
}

// A pair that is misaligned by gamma (rad) with an even stiffness k' per face width: K_Hbeta = 1 + gamma k' b^2 / (2 F)
// up to 2, where one end just loses contact, then b sqrt(2 k' gamma / F). Exact for any number of stations.
BOOST_AUTO_TEST_CASE(misaligned_pair) {
  annulus::test::Verification record("Load distribution of a misaligned pair", "closed form for an even stiffness");
  const double b = 0.2, k = 14e9 * b, force = 40e3;
  for (const double slope : {0.0, 2e-5, 7.1e-5, 1.4e-4, 3e-4, 2e-3}) {
    for (const int segments : {1, 7}) {
      std::vector<double> stations, gap;
      for (int i = 0; i <= segments; ++i) {
        stations.push_back(b * (static_cast<double>(i) / segments - 0.5));
        gap.push_back(slope * stations.back());
      }
      const EvenFace face(k, stations, gap);
      double low = -1e-3, high = 1e-3;
      for (int i = 0; i < 200; ++i) {
        const double middle = (low + high) / 2;
        const auto state = face.at(Eigen::VectorXd::Constant(segments + 1, middle));
        (state.force.sum() < force ? low : high) = middle;
      }
      const Eigen::VectorXd approach = Eigen::VectorXd::Constant(segments + 1, high);
      const double ratio = face.line_load(approach, face.at(approach)).maxCoeff() * b / force;
      const double gentle = 1 + slope * k / b * b * b / (2 * force);
      const double expected = gentle <= 2 ? gentle : b * std::sqrt(2 * k / b * slope / force);
      record.close("K_Hbeta at six slopes, 1 and 7 stretches", "", ratio, expected, 1e-10, "bisection");
    }
  }
}

// Meshes that press on each other through a common body: energy, and the forces by hand where all of them touch.
BOOST_AUTO_TEST_CASE(coupled_faces) {
  annulus::test::Verification record("Meshes coupled through the ring", "linear equations by hand; differences");
  std::vector<std::shared_ptr<const annulus::FaceLaw>> meshes;
  for (const double k : {2e9, 3e9, 4e9})
    meshes.push_back(
        std::make_shared<EvenFace>(k, std::vector<double>{-0.05, 0.0, 0.05}, std::vector<double>{0, 0, 0}));
  Eigen::Matrix3d d;
  d << 0, 4e-11, -2e-11, 4e-11, 0, 5e-11, -2e-11, 5e-11, 0;
  const CoupledFaces law(meshes, d);
  BOOST_TEST(law.size() == 9);
  Eigen::VectorXd approach(9);
  approach << 30e-6, 32e-6, 34e-6, 20e-6, 20e-6, 20e-6, 25e-6, 24e-6, 23e-6;
  const auto state = law.at(approach);
  // (1/k + D) F = mean approach.
  Eigen::Matrix3d compliance = d;
  compliance.diagonal() += Eigen::Vector3d(1 / 2e9, 1 / 3e9, 1 / 4e9);
  const Eigen::Vector3d expected = compliance.inverse() * Eigen::Vector3d(32e-6, 20e-6, 24e-6);
  for (int n = 0; n < 3; ++n)
    record.close("forces of three meshes", "N", state.force.segment(3 * n, 3).sum(), expected[n], 1e-12, "rounding");
  BOOST_TEST((law.losses(state) - d * expected).norm() <= 1e-12 * (d * expected).norm());
  // Whatever it was asked before.
  Eigen::VectorXd elsewhere = approach;
  elsewhere.segment(3, 3) << 12e-6, -3e-6, -20e-6;
  (void)law.at(elsewhere);
  BOOST_TEST((law.at(approach).force - state.force).norm() <= 1e-12 * state.force.norm());
  const auto smooth = annulus::test::law_slopes(law, approach, 1e-9);
  approach.segment(3, 3) << 12e-6, -3e-6, -20e-6;
  const auto lifted = annulus::test::law_slopes(law, approach, 1e-9);
  record.at_most("force, largest relative difference", "", std::max(smooth.force, lifted.force), 1e-7,
                 "step of the differences");
  record.at_most("tangent, largest relative difference", "", std::max(smooth.tangent, lifted.tangent), 1e-6,
                 "step of the differences");
  const auto tangent = law.at(approach).tangent;
  BOOST_TEST((tangent - tangent.transpose()).cwiseAbs().maxCoeff() <= 1e-9 * tangent.cwiseAbs().maxCoeff());
}

BOOST_AUTO_TEST_CASE(laws_that_give_energy_away_are_refused) {
  Eigen::Matrix2d k;
  k << 1e8, 2e8, 2e8, 1e8;
  BOOST_CHECK_THROW(LinearLaw{k}, annulus::InputError);
  k << 1e8, 2e7, 3e7, 1e8;
  BOOST_CHECK_THROW(LinearLaw{k}, annulus::InputError);
  BOOST_CHECK_THROW(StopLaw(2, 0, 1e-5), annulus::InputError);
  BOOST_CHECK_THROW(StopLaw(2, 1e8, -1e-5), annulus::InputError);
  BOOST_CHECK_THROW(TableLaw({0, 1e-5}, {0, -1}), annulus::InputError);
  BOOST_CHECK_THROW(TableLaw({0, 1e-5}, {1, 2}), annulus::InputError);
  BOOST_CHECK_THROW(TableLaw({0, 1e-5, 2e-5}, {0, 1, 1}), annulus::InputError);
  BOOST_CHECK_THROW(EvenFace(1e9, {0.1, 0.0}, {0.0, 0.0}), annulus::InputError);
  BOOST_CHECK_THROW(EvenFace(-1, {0.0, 0.1}, {0.0, 0.0}), annulus::InputError);
}

BOOST_AUTO_TEST_SUITE_END()
