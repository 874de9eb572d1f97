#include <fmt/format.h>

#include <Eigen/Dense>
#include <boost/test/unit_test.hpp>
#include <string>
#include <vector>

#include "core/csv.h"
#include "core/files.h"
#include "core/json.h"
#include "tests/app/run_program.h"
#include "tests/app/scene_refusal.h"
#include "tests/app/scenes.h"
#include "tests/app/statics_scenes.h"
#include "tests/temporary_folder.h"
#include "tests/verification_record.h"

/// A housing that gives way, from a scene and its file to results.
BOOST_AUTO_TEST_SUITE(housing)

using namespace annulus;
using namespace annulus::test::statics;
using Matrix5 = Eigen::Matrix<double, 5, 5>;

namespace {

/// Of the places of three bearings, without a pattern.
Matrix5 place(int number, double side = 1) {
  Matrix5 k;
  k << 3e9, 2e8, 1e7, 1e7, 2e7,  //
      2e8, 2e9, 2e7, -1e7, 3e7,  //
      1e7, 2e7, 1e9, 1e6, 2e6,   //
      1e7, -1e7, 1e6, 2e7, 1e5,  //
      2e7, 3e7, 2e6, 1e5, 3e7;
  const Eigen::Vector<double, 5> sign(1, side, 1, side, 1);
  return (1 + 0.3 * number) * Matrix5(sign.asDiagonal() * k * sign.asDiagonal());
}

Matrix5 bearing_matrix() { return Eigen::Vector<double, 5>(3e9, 3e9, 1e9, 1e7, 1e7).asDiagonal(); }

/// A table of the housing; `turning`: how the rotation of "main_down" about z acts on its other coordinates.
Csv table_of(const std::vector<std::pair<std::string, Matrix5>>& places, double side = 1) {
  Csv csv;
  const auto size = 5 * std::ssize(places) + 1;
  Eigen::MatrixXd all = Eigen::MatrixXd::Zero(size, size);
  Eigen::Index first = 0;
  for (const auto& [name, stiffness] : places) {
    for (const auto* what : {"x_m", "y_m", "z_m", "about_x_rad", "about_y_rad"})
      csv.columns.push_back(name + "_" + what);
    all.block<5, 5>(first, first) = stiffness;
    // Rotations about z, on which nothing acts, leave of every stiffness what it is here.
    if (name == "main_down") {
      csv.columns.emplace_back("main_down_about_z_rad");
      const Eigen::Vector<double, 5> lever(side * 2e7, 1e7, side * 3e6, 1e5, side * 2e5);
      all.block<5, 5>(first, first) += lever * lever.transpose() / 1e8;
      all.block<5, 1>(first, first + 5) = lever;
      all.block<1, 5>(first + 5, first) = lever.transpose();
      all(first + 5, first + 5) = 1e8;
      ++first;
    }
    first += 5;
  }
  for (Eigen::Index i = 0; i < size; ++i) csv.rows.emplace_back(all.row(i).begin(), all.row(i).end());
  return csv;
}

std::string bearings(const std::string& carrier, const std::string& ring) {
  return bearing("planets", "planet", "radial_N_per_m = 3e9\naxial_N_per_m = 1e9\ntilt_Nm_per_rad = 1e6\n") +
         bearing("main up", "carrier", "at_mm = -280\n" + carrier) +
         bearing("main down", "carrier", "at_mm = 300\n" + carrier) +
         bearing("flange", "ring", "at_mm = 100\n" + ring) +
         bearing("spline", "sun", "at_mm = 700\naxial_N_per_m = 3e8\ntilt_Nm_per_rad = 1e6\nradial_N_per_m = 5e7\n");
}

const std::string diagonal = "radial_N_per_m = 3e9\naxial_N_per_m = 1e9\ntilt_Nm_per_rad = 1e7\n";
const std::string file = "[housing]\nstiffness_file = \"housing.csv\"\n";

std::string loaded(const std::string& scene, double side = 1) {
  return scene + fmt::format(
                     "[gravity]\ndirection_deg = {}\n[[load]]\nname = \"rotor\"\nbody = \"carrier\"\n"
                     "moment_Nm = [{}, 100e3, 0]\n",
                     side * 250, side * 50e3);
}

std::string text_of(const Matrix5& matrix) {
  std::string text;
  for (const double value : matrix.reshaped<Eigen::RowMajor>())
    text += fmt::format("{}{}", text.empty() ? "" : ", ", value);
  return "stiffness_5x5_N_m_rad = [" + text + "]\n";
}

}  // namespace

// Points in another order than the bearings, a rotation that bears nothing, a rigid flange: in series by hand.
BOOST_AUTO_TEST_CASE(a_housing_in_a_file) {
  test::Verification record("Housing in a file", "its bearings with stiffness matrices in series");
  const test::TemporaryFolder folder("housing_1");
  table_of({{"flange", place(2)}, {"main_down", place(1)}, {"main_up", place(0)}}).write(folder.path() / "housing.csv");
  const std::string rigid = "radial_N_per_m = \"rigid\"\naxial_N_per_m = \"rigid\"\ntilt_Nm_per_rad = \"rigid\"\n";
  const auto found = solved(folder, loaded(helical_stage() + bearings(diagonal, rigid) + file));
  BOOST_TEST(table(folder, "bodies.csv").column("housing_main_up_x_um") > 0);
  const auto series = [](const Matrix5& below) -> Matrix5 {
    const Matrix5 own = bearing_matrix(), sum = own - own * (own + below).inverse() * own;
    return (sum + sum.transpose()) / 2;
  };
  const auto by_hand =
      bearing("planets", "planet", "radial_N_per_m = 3e9\naxial_N_per_m = 1e9\ntilt_Nm_per_rad = 1e6\n") +
      bearing("main up", "carrier", "at_mm = -280\n" + text_of(series(place(0)))) +
      bearing("main down", "carrier", "at_mm = 300\n" + text_of(series(place(1)))) +
      bearing("flange", "ring", "at_mm = 100\n" + text_of(place(2))) +
      bearing("spline", "sun", "at_mm = 700\naxial_N_per_m = 3e8\ntilt_Nm_per_rad = 1e6\nradial_N_per_m = 5e7\n");
  const auto expected = solved(folder, loaded(helical_stage() + by_hand));
  for (const std::string mesh : {"sun_planet", "ring_planet"})
    for (const std::string key : {"_static_load_sharing", "_static_face_load_factor"})
      record.close("load sharing and face load factors", "", result(found, mesh + key), result(expected, mesh + key),
                   1e-7, "residual of the equilibria");
  // It matters: on rigid ground the faces carry otherwise.
  const auto on_ground = solved(folder, loaded(helical_stage() + bearings(diagonal, rigid)));
  const std::string key = "ring_planet_static_face_load_factor";
  BOOST_TEST(std::abs(result(on_ground, key) / result(found, key) - 1) > 1e-3);
}

// With the torque of the ring in the housing. Turned the other way everything is mirrored.
BOOST_AUTO_TEST_CASE(mirror_image_of_a_housing) {
  test::Verification record("Housing in a file", "symmetry");
  const test::TemporaryFolder one("housing_2"), other("housing_3");
  const auto with_turning_flange = [](double side) {
    auto csv = table_of({{"main_up", place(0, side)}, {"main_down", place(1, side)}, {"flange", place(2, side)}}, side);
    csv.columns.emplace_back("flange_about_z_rad");
    const std::vector<double> on_flange{side * 3e6, 2e6, side * 1e6, 2e5, side * 1e5};
    for (std::size_t i = 0; i < csv.rows.size(); ++i) csv.rows[i].push_back(i < 11 ? 0 : on_flange[i - 11]);
    std::vector<double> last(11, 0.0);
    last.insert(last.end(), on_flange.begin(), on_flange.end());
    last.push_back(4e8);
    csv.rows.push_back(last);
    return csv;
  };
  with_turning_flange(1).write(one.path() / "housing.csv");
  with_turning_flange(1).write(other.path() / "housing.csv");
  const auto a = solved(one, loaded(helical_stage("7.5", "100") + bearings(diagonal, diagonal) + file));
  with_turning_flange(-1).write(other.path() / "housing.csv");
  const auto b = solved(other, loaded(helical_stage("-7.5", "-100") + bearings(diagonal, diagonal) + file, -1));
  for (const std::string mesh : {"sun_planet", "ring_planet"})
    for (const std::string key : {"_static_load_sharing", "_static_face_load_factor"})
      record.close("mirror image", "", result(b, mesh + key), result(a, mesh + key), 1e-9, "residual");
  const auto turn = [](const test::TemporaryFolder& folder) {
    const auto csv = table(folder, "bodies.csv");
    return csv.rows.front().at(csv.column("housing_flange_about_z_urad"));
  };
  record.close("rotation of the flange", "urad", -turn(other), turn(one), 1e-9, "residual");
}

BOOST_AUTO_TEST_CASE(files_that_are_refused) {
  const test::TemporaryFolder folder("housing_4");
  write_file(folder.path() / "scene.toml", helical_stage() + bearings(diagonal, diagonal) + file);
  const auto refused = [&](const Csv& csv, const std::string& text) {
    csv.write(folder.path() / "housing.csv");
    const auto outcome = test::run_program(folder.path(), "check scene.toml");
    BOOST_TEST(outcome.status == 2);
    BOOST_TEST(outcome.err.find("housing.stiffness_file") != std::string::npos, outcome.err);
    BOOST_TEST(outcome.err.find(text) != std::string::npos, outcome.err);
  };
  refused(table_of({{"planets", place(0)}, {"main_down", place(1)}}), "its points main_up, main_down, flange, spline");
  auto csv = table_of({{"main_up", place(0)}, {"main_down", place(1)}});
  csv.columns[4] = "main_up_about_z_rad";
  refused(csv, "has no column main_up_about_y_rad");
  csv = table_of({{"main_up", place(0)}, {"main_down", place(1)}});
  csv.rows[0][1] = 7;
  refused(csv, "not symmetric");
  csv.rows.pop_back();
  refused(csv, "it is a square table");
  csv = table_of({{"main_up", Matrix5::Zero()}, {"main_down", place(1)}});
  refused(csv, "with the foundation held");
  const auto refusal = test::scene_refusal(helical_stage() + file);
  BOOST_TEST(refusal.find("needs bearings that stand on the housing") != std::string::npos, refusal);
}

BOOST_AUTO_TEST_SUITE_END()
