#include <boost/test/unit_test.hpp>
#include <cstdlib>

#include "core/files.h"
#include "tests/app/pair_scenes.h"
#include "tests/app/run_program.h"
#include "tests/app/run_results.h"
#include "tests/app/scenes.h"
#include "tests/app/two_k_v_scenes.h"

namespace annulus {

namespace {

using test::check_same;
using test::results_in;

/// Rings held, on pins and on a thin sleeve: plane and solid elements, supports that open, coupled meshes; motion,
/// a sweep, random draws and a search.
std::string scene_of_everything() {
  const std::string ring = "teeth = 72\ntip_diameter_mm = 282\nprofile_shift = 0\n";
  return "accuracy = 0.2\n" + test::small_stage() + "[[ring]]\nname = \"pinned\"\nstructure = \"pinned\"\npins = 12\n" +
         "pin_diameter_mm = 10\nrim_thickness_mm = 16\nmass_kg = 12\ninertia_kg_m2 = 0.3\n" + ring +
         "[[ring]]\nname = \"thin\"\nstructure = \"thin_walled\"\nfree_length_mm = 15\nsleeve_thickness_mm = 10\n" +
         "rim_thickness_mm = 16\nmass_kg = 12\ninertia_kg_m2 = 0.3\n" + ring + R"([[sweep]]
input = "stage.sun_speed_rpm"
values = [1000, 2500]
[monte_carlo]
samples = 8
seed = 1
[optimise]
objective = ["sun_planet_peak_factor"]
optimisers = ["genetic"]
generations = 2
population = 6
[[optimise.variable]]
input = "supports.planet_N_per_m"
low = 3e8
high = 3e9
)";
}

/// Results of a run with everything that could decide how many threads work set as asked.
std::map<std::string, std::string> results_of(const test::TemporaryFolder& folder, const std::string& text,
                                              const std::string& out, const std::string& threads,
                                              const std::string& before = "") {
  write_file(folder.path() / "scene.toml", text);
  const auto command = "cd '" + folder.path().string() + "' && " + before +
                       " '" ANNULUS_PROGRAM "' run scene.toml -o " + out + " --threads " + threads +
                       " --quiet >/dev/null 2>messages.txt";
  const int raw = std::system(command.c_str());
  BOOST_TEST_REQUIRE(WEXITSTATUS(raw) == 0, read_file(folder.path() / "messages.txt"));
  return results_in(folder.path() / out);
}

}  // namespace

BOOST_AUTO_TEST_SUITE(determinism)

BOOST_AUTO_TEST_CASE(any_number_of_threads_gives_the_same_bits) {
  ::setenv("ANNULUS_CACHE", "", 1);
  const test::TemporaryFolder folder("threads");
  const auto scene = scene_of_everything();
  const auto one = results_of(folder, scene, "one", "1");
  BOOST_TEST_REQUIRE(one.size() > 50U);
  check_same(one, results_of(folder, scene, "two", "2"));
  BOOST_TEST_MESSAGE(one.size() << " results compared bit by bit");
}

BOOST_AUTO_TEST_CASE(libraries_with_threads_of_their_own_change_nothing) {
  ::setenv("ANNULUS_CACHE", "", 1);
  const test::TemporaryFolder folder("library_threads");
  const auto scene = "accuracy = 0.1\nmodel = \"plane\"\n" + test::small_stage();
  const auto plain = results_of(folder, scene, "plain", "2");
  check_same(plain, results_of(folder, scene, "one_core", "3", "taskset -c 0"));
  check_same(plain,
             results_of(folder, scene, "asked", "1", "OPENBLAS_NUM_THREADS=2 OMP_NUM_THREADS=2 DEAL_II_NUM_THREADS=2"));
}

BOOST_AUTO_TEST_CASE(what_is_reused_is_what_would_be_computed) {
  ::setenv("ANNULUS_CACHE", "", 1);
  const test::TemporaryFolder folder("reused_bits");
  const auto scene = scene_of_everything();
  const auto other = test::replaced(scene, "planet_N_per_m = 1e9", "planet_N_per_m = 2e9");
  // Another scene before, whose meshes serve; then the same again, of which everything does.
  (void)results_of(folder, other, "reused", "2");
  const auto after = results_of(folder, scene, "reused", "2");
  const auto again = results_of(folder, scene, "reused", "1");
  check_same(after, again);
  auto fresh = results_of(folder, scene, "fresh", "2");
  // Studies of the other scene stay beside those of this one.
  for (const auto& [place, text] : fresh) {
    const auto it = after.find(place);
    BOOST_TEST((it != after.end()), place << " is missing");
    if (it != after.end() && it->second != text)
      BOOST_ERROR(place << " differs: " << test::difference(place, text, it->second));
  }
}

BOOST_AUTO_TEST_CASE(other_stages_are_equal_too) {
  ::setenv("ANNULUS_CACHE", "", 1);
  const test::TemporaryFolder folder("other_stages");
  const std::string draws =
      "[monte_carlo]\nsamples = 8\nseed = 2\n[[monte_carlo.input]]\ndistribution = \"lognormal\"\n";
  const std::string pair = test::solved_pair() + draws +
                           "input = \"pinion.bearing_transverse_N_per_m\"\nmean = 1e9\ndeviation = 2e8\n" +
                           "[transmission_error]\npinion_torques_Nm = [300, 600]\n";
  check_same(results_of(folder, pair, "pair1", "1"), results_of(folder, pair, "pair2", "2"));
  const std::string reducer =
      test::reducer_scene() + draws + "input = \"crank.bearing_N_per_m\"\nmean = 1.5e8\ndeviation = 3e7\n";
  check_same(results_of(folder, reducer, "reducer1", "1"), results_of(folder, reducer, "reducer2", "2"));
}

BOOST_AUTO_TEST_SUITE_END()

}  // namespace annulus
