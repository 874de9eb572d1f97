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
    BOOST_TEST(result(statics, mesh + "_static_face_load_factor") > 1.05);
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

BOOST_AUTO_TEST_SUITE_END()
