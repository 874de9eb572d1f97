#include <fmt/format.h>

#include <boost/test/unit_test.hpp>
#include <string>

#include "core/files.h"
#include "core/json.h"
#include "tests/app/run_program.h"
#include "tests/app/statics_scenes.h"
#include "tests/temporary_folder.h"
#include "tests/verification_record.h"

/// annulus statics on solid gears.
BOOST_AUTO_TEST_SUITE(statics_solid)

using namespace annulus;
using namespace annulus::test::statics;

// Solid gears along their faces against the tables of the same meshes in the lumped model: nothing tilts, the sun is
// held softly, and one pin stands beside its place. Elements and load steps of the tables leave a percent of the
// stiffness, of which a tenth of the excess of the load sharing is left.
BOOST_AUTO_TEST_CASE(solid_faces_share_the_load_as_tables_do) {
  test::Verification record("annulus statics on solid helical gears", "quasi-static load sharing of annulus run");
  const test::TemporaryFolder folder("statics_solid");
  const auto scene = solid_stage();
  const auto statics = solved(folder, scene);
  const auto run = test::run_program(folder.path(), "run scene.toml --out out --quiet");
  BOOST_TEST_REQUIRE(run.status == 0, run.err);
  const auto summary = Json::parse(read_file(folder.path() / "out/summary.json"));
  for (const std::string mesh : {"sun_planet", "ring_planet"}) {
    const double other = summary.at("rings").at("held").at("load_sharing").at(mesh).at("quasi_static").at("value");
    BOOST_TEST(other > 1.02);
    record.near("largest load sharing in any position", "",
                result(statics, mesh + "_static_load_sharing_instantaneous"), other, 0.02 * (other - 1) + 1e-3,
                "accuracy of the tables");
    BOOST_TEST(result(statics, mesh + "_static_face_load_factor") > 1.02);
    BOOST_TEST(result(statics, mesh + "_static_face_load_factor_instantaneous") >
               result(statics, mesh + "_static_face_load_factor"));
  }
}

BOOST_AUTO_TEST_CASE(same_on_any_number_of_threads) {
  const test::TemporaryFolder folder("statics_threads");
  for (const auto& [name, scene] : {std::pair{"even", helical_stage() + in_space()}, {"solid", solid_stage()}}) {
    write_file(folder.path() / "scene.toml", scene);
    std::string first;
    for (const std::string threads : {"1", "2", "5"}) {
      const auto outcome = test::run_program(
          folder.path(), fmt::format("statics scene.toml --quiet --threads {0} -o {1}{0}", threads, name));
      BOOST_TEST_REQUIRE(outcome.status == 0, outcome.err);
      const auto out = folder.path() / (name + threads);
      const auto all = read_file(out / "statics.json") + read_file(out / "statics/held/bearings.csv");
      if (first.empty()) first = all;
      BOOST_TEST((all == first));
    }
  }
}

// The dynamics has the faces of solid gears as straight about their load. While the stage turns slowly, load sharing,
// places of the forces and bearing forces are those of the exact faces.
BOOST_AUTO_TEST_CASE(slow_motion_has_the_faces_of_the_statics) {
  test::Verification record("annulus run with solid gears along their face", "annulus statics, exact flanks");
  const test::TemporaryFolder folder("statics_solid_motion");
  auto scene = test::replaced(solid_stage(), "accuracy = 0.05\n", "accuracy = 0.05\nmodel = \"solid\"\n");
  scene = test::replaced(scene, "sun_speed_rpm = 100\n", "sun_speed_rpm = 10\n");
  scene += "[tilt_inertia]\nsun_kg_m2 = 2\nplanet_kg_m2 = 2\nring_kg_m2 = 90\ncarrier_kg_m2 = 60\n" +
           bearing("upwind row", "planet", "at_mm = -60\nradial_N_per_m = 2e9\naxial_N_per_m = 1e9\n") +
           bearing("downwind row", "planet", "at_mm = 60\nradial_N_per_m = 2e9\n") +
           bearing("upwind", "carrier", "at_mm = -300\nradial_N_per_m = 5e9\naxial_N_per_m = 1e9\n") +
           bearing("downwind", "carrier", "at_mm = 300\nradial_N_per_m = 5e9\n") +
           bearing("spline", "sun", "at_mm = 600\nradial_N_per_m = 2e8\naxial_N_per_m = 1e9\ntilt_Nm_per_rad = 1e8\n");
  const auto statics = solved(folder, scene);
  const auto run = test::run_program(folder.path(), "run scene.toml --out out --quiet");
  BOOST_TEST_REQUIRE(run.status == 0, run.err);
  const auto summary = Json::parse(read_file(folder.path() / "out/summary.json"));
  const auto& held = summary.at("rings").at("held");
  for (const std::string mesh : {"sun_planet", "ring_planet"})
    record.near("load sharing", "", held.at("load_sharing").at(mesh).at("averaged").at("value").get<double>(),
                result(statics, mesh + "_static_load_sharing"), 5e-3, "linear in load and tilt");
  for (const std::string mesh : {"sun_planet", "ring_planet"})
    record.close("K_Hβ of a mesh cycle", "", face_load_factor_in_motion(summary, mesh),
                 result(statics, mesh + "_static_face_load_factor"), 2e-2,
                 "linear in load and tilt, without lean; eight phases");
  const auto forces = table(folder, "mesh_forces.csv");
  double largest_swing = 0;
  for (const std::string mesh : {"sun_planet1", "sun_planet2", "sun_planet3", "ring_planet1", "ring_planet3"}) {
    double mean = 0, least = 1, most = -1;
    for (const auto& row : forces.rows) {
      const double place = row[forces.column(mesh + "_load_at_mm")] * 1e-3;
      mean += place / static_cast<double>(forces.rows.size());
      least = std::min(least, place);
      most = std::max(most, place);
    }
    largest_swing = std::max(largest_swing, most - least);
    const auto& found = held.at("places_of_mesh_forces").at(mesh);
    const auto at = [&](const char* key) { return found.at(key).get<double>(); };
    record.near("place of the force along the face of 220 mm, mean", "m", at("mean_m"), mean, 2e-3,
                "linear in load and tilt");
    record.near("the same, how far it moves", "m", at("max_m") - at("min_m"), most - least, 3e-3,
                "eight phases; linear in load and tilt");
  }
  BOOST_TEST(largest_swing > 5e-3);
}

BOOST_AUTO_TEST_SUITE_END()
