#include <fmt/format.h>

#include <algorithm>
#include <boost/test/unit_test.hpp>
#include <nlohmann/json.hpp>

#include "app/systems/planetary/report/stage_report_parts.h"
#include "core/files.h"
#include "tests/app/made_up_solution.h"
#include "tests/app/pair_scenes.h"
#include "tests/app/run_program.h"
#include "tests/app/scenes.h"
#include "tests/temporary_folder.h"

/// Report pages in a browser: headless Chromium draws them and uses every plot.
namespace annulus {

namespace {

/// What report_page.js saw of a page.
nlohmann::json used_in_browser(const std::filesystem::path& folder, std::string page, int width = 1400,
                               const std::string& more_script = {}) {
  const auto end = page.rfind("</body>");
  BOOST_REQUIRE(end != std::string::npos);
  page.insert(
      end, "<script>" + more_script + "\n" + read_file(ANNULUS_SOURCE_DIR "/tests/app/report_page.js") + "</script>");
  write_file(folder / "used.html", page);
  // A profile of its own: tests run side by side.
  const auto command = fmt::format(
      "cd '{0}' && timeout 400 chromium --headless --no-sandbox --use-angle=swiftshader --enable-unsafe-swiftshader "
      "--disable-dev-shm-usage "
      "--user-data-dir='{0}/profile' --window-size={1},1000 --virtual-time-budget=20000 --dump-dom "
      "'file://{0}/used.html' "
      ">dom.html 2>chromium.txt",
      folder.string(), width);
  BOOST_REQUIRE(std::system(command.c_str()) == 0);
  const auto dom = read_file(folder / "dom.html");
  const std::string head = "<pre id=\"result\">";
  const auto begin = dom.find(head);
  BOOST_REQUIRE_MESSAGE(begin != std::string::npos, dom.substr(0, 500));
  const auto start = begin + head.size();
  std::string text = dom.substr(start, dom.find("</pre>", start) - start);
  for (const auto& [from, to] : {std::pair{"&gt;", ">"}, {"&amp;", "&"}})
    for (std::size_t at; (at = text.find(from)) != std::string::npos;) text.replace(at, std::string(from).size(), to);
  return nlohmann::json::parse(text);
}

/// The page that the program writes about a scene.
std::string written_page(const std::filesystem::path& folder, const std::string& command, const std::string& scene) {
  write_file(folder / "scene.toml", scene);
  const auto outcome = test::run_program(folder, command + " scene.toml -o out --threads 2");
  BOOST_REQUIRE_MESSAGE(outcome.status == 0, outcome.err);
  return read_file(folder / "out" / "report.html");
}

void check_used(const nlohmann::json& used, int least_plots) {
  BOOST_TEST(used["failures"].empty(), used["failures"].dump());
  const int plots = used["plots"];
  BOOST_TEST(plots >= least_plots);
  for (const char* what : {"drawn", "zoomed", "reset", "hidden", "told"})
    BOOST_TEST(used[what].get<int>() == plots, what << ": " << used["unusable"].dump());
  BOOST_TEST(used["rows"].get<int>() > 10 * plots);
  BOOST_TEST(used["fetched"].get<int>() == 0);  // nothing from outside
  BOOST_TEST(used["cropped"].empty(), used["cropped"].dump());
}

}  // namespace

BOOST_AUTO_TEST_SUITE(report_page)

BOOST_AUTO_TEST_CASE(every_plot_of_a_stage_can_be_used) {
  const test::TemporaryFolder folder("report_page");
  const auto used = used_in_browser(folder.path(), written_page(folder.path(), "run", test::quick_scene()));
  check_used(used, 15);

  BOOST_TEST(used["bars"].get<int>() >= 1);  // the answer
  BOOST_TEST(used["one_planet"].get<bool>());

  // Ring, sun, five planets and as many carrier arms of every mode shape.
  BOOST_TEST(used["swinging"].get<int>() >= 2 * 12);
  BOOST_TEST(used["swinging"].get<int>() % 12 == 0);

  // Every picture of the page is a file that other programs draw.
  int pictures = 0;
  for (const auto& entry : std::filesystem::directory_iterator(folder.path() / "out" / "pictures")) {
    ++pictures;
    BOOST_TEST(read_file(entry.path()).starts_with("<svg xmlns="));
    if (pictures > 3) continue;
    const auto drawn =
        test::run_program(folder.path(), "export '" + entry.path().string() + "' --to png -o picture.png");
    BOOST_TEST(drawn.status == 0, drawn.err);
    BOOST_TEST(read_file(folder.path() / "picture.png").starts_with("\x89PNG"));
    BOOST_TEST(std::filesystem::file_size(folder.path() / "picture.png") > 10000U);
  }
  BOOST_TEST(pictures >= used["plots"].get<int>());
}

BOOST_AUTO_TEST_CASE(every_plot_of_solved_meshes_can_be_used) {
  const test::TemporaryFolder folder("report_page_meshes");
  const auto scene = app::read_scene(ANNULUS_SOURCE_DIR "/data/scenes/ring_structures.toml");
  const auto used = used_in_browser(folder.path(), app::page_html(app::stage_report(test::made_up_run(scene, 4))));
  check_used(used, 20);
  BOOST_TEST(used["bands"].get<int>() > 5);
  BOOST_TEST(used["map"].get<int>() >= 2);  // pins around the ring, pressures
}

BOOST_AUTO_TEST_CASE(deformed_bodies_can_be_turned) {
  const test::TemporaryFolder folder("report_page_fields");
  const auto used = used_in_browser(folder.path(), written_page(folder.path(), "solve", test::small_stage()));
  check_used(used, 5);
  BOOST_TEST(used["bodies"].get<int>() >= 2);  // planet and wheel of both meshes
  for (const char* what : {"shown", "turned", "undeformed"})
    BOOST_TEST(used[what].get<int>() == used["bodies"].get<int>(), what << ": " << used.dump());

  // In pixels, whatever the unit of the picture: width and height stand behind the signature of a PNG file.
  int bodies = 0;
  for (const auto& entry : std::filesystem::directory_iterator(folder.path() / "out" / "pictures")) {
    if (entry.path().filename().string().find("_fields_") == std::string::npos) continue;
    ++bodies;
    const auto drawn =
        test::run_program(folder.path(), "export '" + entry.path().string() + "' --to png -o picture.png");
    BOOST_TEST(drawn.status == 0, drawn.err);
    const std::string png = read_file(folder.path() / "picture.png");
    const auto pixels = [&](std::size_t at) {
      int value = 0;
      for (std::size_t i = 0; i < 4; ++i) value = 256 * value + static_cast<unsigned char>(png.at(at + i));
      return value;
    };
    BOOST_TEST(std::max(pixels(16), pixels(20)) >= 1600);
  }
  BOOST_TEST(bodies == 2);

  // Their files, read by Python.
  int fields = 0;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder.path() / "out")) {
    const auto name = entry.path().filename().string();
    if (name.find("_field_") == std::string::npos || entry.path().extension() != ".vtu") continue;
    ++fields;
    const auto command = fmt::format("'" ANNULUS_PYTHON "' '" ANNULUS_SOURCE_DIR "/tests/app/read_exports.py' vtu '{}'",
                                     entry.path().string());
    BOOST_TEST(std::system((command + " >'" + (folder.path() / "vtu.txt").string() + "'").c_str()) == 0);
    BOOST_TEST(std::stoi(read_file(folder.path() / "vtu.txt")) > 1000);
  }
  BOOST_TEST(fields == 4);
}

BOOST_AUTO_TEST_CASE(deformed_pairs_can_be_turned) {
  const test::TemporaryFolder folder("report_page_pair_fields");
  const auto page = written_page(folder.path(), "solve", test::solved_pair());
  std::string pictures;
  for (const auto& entry : std::filesystem::directory_iterator(folder.path() / "out" / "pictures"))
    pictures += entry.path().filename().string() + "\n";
  BOOST_TEST(pictures.find("deformed_pinion_and_wheel") != std::string::npos, pictures);
  const auto used = used_in_browser(folder.path(), page);
  BOOST_TEST(used["bodies"].get<int>() == 1);
  for (const char* what : {"shown", "turned", "undeformed"}) BOOST_TEST(used[what].get<int>() == 1, what);
}

/// axe-core, which scripts/install_packages.sh --all fetches from npm, finds nothing in a page with all its folds open.
BOOST_AUTO_TEST_CASE(pages_can_be_read_by_everyone) {
  const std::filesystem::path axe = ANNULUS_NODE_MODULES "/axe-core/axe.min.js";
  BOOST_TEST_REQUIRE(std::filesystem::exists(axe), "run scripts/install_packages.sh --all, which fetches axe-core");
  const test::TemporaryFolder folder("report_page_access");
  const auto text = test::quick_scene() + "[tolerances]\naccuracy_class = 6\nassemblies = 100\n";
  const auto used = used_in_browser(folder.path(), written_page(folder.path(), "run", text), 1400,
                                    read_file(axe) + "\nwindow.check_access = true;");
  BOOST_TEST(used["inaccessible"].empty(), used["inaccessible"].dump(1));
  check_used(used, 15);
}

// What decides is open, the rest folded: few screens, a small page, and no scrolling sideways on a phone.
BOOST_AUTO_TEST_CASE(pages_are_short_and_small) {
  const test::TemporaryFolder folder("report_page_size");
  const auto page = written_page(folder.path(), "run", test::quick_scene());
  constexpr std::size_t most = 1'500'000;
  BOOST_TEST(page.size() < most);
  for (const auto& [width, least_folds] : {std::pair{1400, 5}, {500, 5}}) {
    const auto used = used_in_browser(folder.path(), page, width);
    BOOST_TEST(used["folds"].get<int>() >= least_folds);
    BOOST_TEST(!used["wide"].get<bool>(), width);
    if (width > 1000) BOOST_TEST(used["screens"].get<double>() <= 8);
  }
}

BOOST_AUTO_TEST_CASE(what_a_scene_says_stays_text) {
  const test::TemporaryFolder folder("report_page_text");
  const std::string hostile = "</script><script>window.failures.push('ran')</script><!--";
  const auto text = test::replaced(test::quick_scene(), "title = \"Quick\"", "title = \"" + hostile + "\"");
  check_used(used_in_browser(folder.path(), written_page(folder.path(), "run", text)), 15);
}

BOOST_AUTO_TEST_SUITE_END()

}  // namespace annulus
