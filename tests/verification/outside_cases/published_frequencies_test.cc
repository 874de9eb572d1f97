#include <Eigen/Core>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <boost/test/unit_test.hpp>
#include <cmath>
#include <fstream>
#include <numbers>
#include <sstream>
#include <vector>

#include "core/units.h"
#include "tests/verification/outside_cases/outside_case.h"
#include "tests/verification_record.h"

namespace {

using annulus::test::OutsideCase;
using annulus::test::Verification;

/// The inputs that the papers print, SI: sun, ring, carrier, planet.
struct PublishedStage {
  double mass[4], inertia_over_r2[4], support[3], torsional[3];
  double planet_bearing, mesh, pressure_angle;
};

constexpr PublishedStage cooley_parker{
    {3, 7.64, 12, 1.86},     {1.75, 8.09, 6.80, 1.25}, {20e6, 100e6, 50e6}, {20e6, 100e6, 100e6}, 10e6, 100e6,
    20 * annulus::units::deg};
constexpr PublishedStage lin_parker{
    {0.4, 2.35, 5.43, 0.66},   {0.39, 3.00, 6.29, 0.61}, {1e8, 1e8, 1e8}, {0, 1e9, 0}, 1e8, 5e8,
    24.6 * annulus::units::deg};

/// Rising natural frequencies, Hz, of the equations of Lin and Parker, written out here once more: DOFs x, y,
/// u = r theta of each body, those of planets radial and tangential.
std::vector<double> frequencies_of_the_equations(const PublishedStage& s, int planets) {
  const int n = 9 + 3 * planets;
  Eigen::MatrixXd stiffness = Eigen::MatrixXd::Zero(n, n);
  Eigen::VectorXd mass(n);
  for (int body = 0; body < 3; ++body) {
    mass.segment<3>(3 * body) << s.mass[body], s.mass[body], s.inertia_over_r2[body];
    stiffness.diagonal().segment<3>(3 * body) << s.support[body], s.support[body], s.torsional[body];
  }
  const double sine = std::sin(s.pressure_angle), cosine = std::cos(s.pressure_angle);
  for (int planet = 0; planet < planets; ++planet) {
    const double position = 2 * std::numbers::pi * planet / planets;
    const int p = 9 + 3 * planet;
    mass.segment<3>(p) << s.mass[3], s.mass[3], s.inertia_over_r2[3];
    const auto spring = [&](double k, int body, const Eigen::Vector3d& on_body, const Eigen::Vector3d& on_planet) {
      Eigen::VectorXd b = Eigen::VectorXd::Zero(n);
      b.segment<3>(3 * body) = on_body;
      b.segment<3>(p) = on_planet;
      stiffness += k * b * b.transpose();
    };
    const double sun = position - s.pressure_angle, ring = position + s.pressure_angle;
    spring(s.mesh, 0, {-std::sin(sun), std::cos(sun), 1}, {-sine, -cosine, 1});
    spring(s.mesh, 1, {-std::sin(ring), std::cos(ring), 1}, {sine, -cosine, -1});
    spring(s.planet_bearing, 2, {-std::cos(position), -std::sin(position), 0}, {1, 0, 0});
    spring(s.planet_bearing, 2, {std::sin(position), -std::cos(position), -1}, {0, 1, 0});
  }
  const Eigen::VectorXd scale = mass.cwiseSqrt().cwiseInverse();
  const Eigen::MatrixXd scaled = scale.asDiagonal() * stiffness * scale.asDiagonal();
  const Eigen::VectorXd squares = Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(scaled).eigenvalues();
  std::vector<double> list;
  for (const double square : squares) list.push_back(std::sqrt(std::max(0.0, square)) / (2 * std::numbers::pi));
  return list;
}

struct ComputedModes {
  std::vector<double> all;                           ///< Hz, rising
  std::map<std::string, std::vector<double>> kinds;  ///< Hz, rising, by kind
};

ComputedModes computed_modes(const std::filesystem::path& out) {
  std::ifstream file(out / "published" / "dynamics" / "modes.csv");
  ComputedModes modes;
  std::string line;
  while (std::getline(file, line)) {
    std::istringstream cells(line);
    std::string index, frequency, kind;
    if (line.front() == '#' || line.rfind("index", 0) == 0) continue;
    std::getline(cells, index, ',');
    std::getline(cells, frequency, ',');
    std::getline(cells, kind, ',');
    modes.all.push_back(std::stod(frequency));
    modes.kinds[kind].push_back(std::stod(frequency));
  }
  return modes;
}

/// `unit`: Hz of a printed one. `tolerance`: of printed values, in their unit.
template <class Tolerance>
void compare_frequencies(Verification& record, const OutsideCase& published, const ComputedModes& modes,
                         const std::string& planets, double unit, const Tolerance& tolerance,
                         const std::string& origin) {
  const std::map<std::string, int> multiplicity = {
      {"rotational", 1}, {"translational", 2}, {"planet", planets == "four" ? 1 : 0}};
  for (const auto& [kind, times] : multiplicity) {
    if (times == 0) continue;
    const auto& list = modes.kinds.at(kind);
    const std::size_t count = kind == "planet" ? 3 : 6;
    BOOST_TEST_REQUIRE(list.size() == count * static_cast<std::size_t>(times));
    for (std::size_t i = 0; i < list.size(); ++i) {
      const auto number = std::to_string(i / static_cast<std::size_t>(times) + 1);
      const auto& printed = published.printed(planets + "_planets_" + kind + "_" + number);
      record.near(planets + " planets, " + kind + " mode " + number, printed.unit, list[i] / unit, printed.value,
                  tolerance(printed), origin);
    }
  }
}

void compare_with_equations(Verification& record, const ComputedModes& modes, const PublishedStage& stage,
                            int planets) {
  const auto expected = frequencies_of_the_equations(stage, planets);
  BOOST_TEST_REQUIRE(modes.all.size() == expected.size());
  for (std::size_t i = 0; i < expected.size(); ++i) {
    const bool turning = expected[i] < 1;  // free to turn: the root of a square that is zero but for rounding
    record.near(turning ? "frequency of turning as a whole" : "every frequency, from the equations written out", "Hz",
                modes.all[i], turning ? 0 : expected[i], turning ? 0 : 1e-8 * expected[i],
                turning ? "exactly 0" : "ten digits of the inertias in the scene");
  }
}

}  // namespace

BOOST_AUTO_TEST_SUITE(published_frequencies)

BOOST_AUTO_TEST_CASE(cooley_and_parker) {
  Verification record("Natural frequencies of the planetary gear of Cooley and Parker at standstill, from its scenes",
                      "Cooley and Parker, J. Vib. Acoust. 134(6) (2012), table of natural frequencies over "
                      "sqrt(k_p / m_p), digits as printed (data/cases/cooley_parker_2012); the equations of Lin and "
                      "Parker written out in the test");
  const OutsideCase published("cooley_parker_2012");
  const double unit = std::sqrt(cooley_parker.planet_bearing / cooley_parker.mass[3]) / (2 * std::numbers::pi);
  for (const auto& [planets, number] : {std::pair{"three", 3}, {"four", 4}}) {
    const auto modes = computed_modes(published.run(std::string(planets) + "_planets.toml"));
    compare_frequencies(
        record, published, modes, planets, unit, [](const auto& printed) { return 2 * printed.half_unit; },
        "one unit of the last printed digit: half for the result, half for the inputs, printed with three digits");
    compare_with_equations(record, modes, cooley_parker, number);
  }
}

BOOST_AUTO_TEST_CASE(lin_and_parker) {
  Verification record("Natural frequencies of the planetary gear of Lin and Parker at standstill, from its scenes",
                      "Lin and Parker, J. Vib. Acoust. 121(3) (1999), table of the example with four planets "
                      "(data/cases/lin_parker_1999); its equations written out in the test");
  const OutsideCase published("lin_parker_1999");
  for (const auto& [planets, number] : {std::pair{"three", 3}, {"four", 4}}) {
    const auto modes = computed_modes(published.run(std::string(planets) + "_planets.toml"));
    if (number == 4)
      compare_frequencies(
          record, published, modes, planets, 1, [](const auto& printed) { return 5e-4 * printed.value; },
          "inputs printed with two or three digits");
    compare_with_equations(record, modes, lin_parker, number);
  }
}

BOOST_AUTO_TEST_SUITE_END()
