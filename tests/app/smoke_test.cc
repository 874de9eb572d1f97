#include <boost/test/unit_test.hpp>
#include <filesystem>
#include <string>
#include <utility>

#include "core/files.h"
#include "tests/app/pair_scenes.h"
#include "tests/app/run_program.h"
#include "tests/app/scenes.h"
#include "tests/app/two_k_v_scenes.h"
#include "tests/temporary_folder.h"

/// One run of every kind of gear system by the program, in a few seconds together.
namespace annulus {

BOOST_AUTO_TEST_SUITE(smoke)

BOOST_AUTO_TEST_CASE(every_kind_runs_and_is_not_run_twice) {
  const test::TemporaryFolder folder("smoke");
  const std::string train = R"(title = "Train"
[stage]
kind = "train"
[[part]]
name = "first"
file = "pair.toml"
[[part]]
name = "second"
file = "pair.toml"
[[shaft]]
name = "between"
from = "first.wheel"
to = "second.pinion"
stiffness_Nm_per_rad = 5e7
[dynamics]
support_damping_ratio = 0.05
)";
  // Its teeth never lose contact, so that no other motions are looked for.
  write_file(folder.path() / "pair.toml",
             test::replaced(test::quick_pair(), "half_backlash_um = 150", "half_backlash_um = 0"));
  for (const auto& [kind, scene] : {std::pair<std::string, std::string>{"planetary", test::quick_scene()},
                                    {"helical_pair", test::quick_pair()},
                                    {"two_k_v", test::reducer_scene()},
                                    {"train", train}}) {
    write_file(folder.path() / (kind + ".toml"), scene);
    const auto command = "run " + kind + ".toml -o " + kind;
    const auto first = test::run_program(folder.path(), command);
    BOOST_TEST_REQUIRE(first.status == 0, kind << ": " << first.err);
    for (const auto* file : {"figures.csv", "summary.json", "report.html", "run.log"})
      BOOST_TEST(std::filesystem::file_size(folder.path() / kind / file) > 100U, kind << "/" << file);
    if (kind == "train") {
      const auto summary = read_file(folder.path() / kind / "summary.json");
      BOOST_TEST(summary.find("a train draws no samples of them") != std::string::npos);
      BOOST_TEST(summary.find("samples of them are drawn") == std::string::npos);
    }
    const auto again = test::run_program(folder.path(), command);
    BOOST_TEST(again.status == 0, kind << ": " << again.err);
    BOOST_TEST(again.out.find("nothing has changed") != std::string::npos, kind << ": " << again.out);
  }
}

BOOST_AUTO_TEST_SUITE_END()

}  // namespace annulus
