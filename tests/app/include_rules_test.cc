#include <algorithm>
#include <boost/test/unit_test.hpp>
#include <filesystem>
#include <fstream>
#include <regex>
#include <string>
#include <vector>

/// The layers of the tree: who may include what (CONTRIBUTING.md).
namespace annulus {

namespace {

struct Include {
  std::string file, layer, path;
  bool header = false, internal = false;
};

/// All #include lines of one layer.
std::vector<Include> includes_of(const std::string& layer) {
  namespace fs = std::filesystem;
  static const std::regex line_pattern(R"re(^\s*#\s*include\s*[<"]([^>"]+)[>"])re");
  std::vector<Include> includes;
  for (const auto& entry : fs::recursive_directory_iterator(fs::path(ANNULUS_SOURCE_DIR) / layer)) {
    const auto extension = entry.path().extension();
    if (extension != ".h" && extension != ".cc") continue;
    std::ifstream in(entry.path());
    std::string line;
    std::smatch match;
    while (std::getline(in, line)) {
      if (!std::regex_search(line, match, line_pattern)) continue;
      const auto relative = fs::relative(entry.path(), ANNULUS_SOURCE_DIR);
      // Folders within a layer are its own business; its contract lies at its top. The application has parts of a
      // layer's size, whose contracts lie at theirs.
      const bool internal = std::distance(relative.begin(), relative.end()) > (layer == "app" ? 3 : 2);
      includes.push_back({relative.string(), layer, match[1], extension == ".h", internal});
    }
  }
  return includes;
}

const std::vector<std::string> layers = {"core", "geometry", "fem", "dynamics", "app"};

bool starts_with_any(const std::string& text, const std::vector<std::string>& heads) {
  for (const auto& head : heads) {
    if (text.starts_with(head)) return true;
  }
  return false;
}

}  // namespace

BOOST_AUTO_TEST_SUITE(include_rules)

BOOST_AUTO_TEST_CASE(layers_see_only_what_lies_below) {
  const std::vector<std::pair<std::string, std::vector<std::string>>> forbidden = {
      {"core", {"geometry/", "fem/", "dynamics/", "app/"}},
      {"geometry", {"fem/", "dynamics/", "app/"}},
      {"fem", {"dynamics/", "app/"}},
      {"dynamics", {"fem/", "app/"}},
  };
  for (const auto& [layer, heads] : forbidden) {
    for (const auto& include : includes_of(layer)) {
      BOOST_TEST(!starts_with_any(include.path, heads), include.file << " includes " << include.path);
    }
  }
}

BOOST_AUTO_TEST_CASE(heavy_libraries_stay_in_their_layer) {
  struct Rule {
    std::string layer;
    std::vector<std::string> heads;
  };
  const std::vector<Rule> rules = {
      {"fem", {"deal.II/", "cholmod", "suitesparse/"}},
      {"geometry", {"gmsh"}},
      {"dynamics", {"sundials/", "cvode", "arkode", "nvector/", "sunmatrix/", "sunlinsol/"}},
      {"app", {"toml++/", "CLI/", "nlohmann/"}},
  };
  for (const auto& layer : layers) {
    for (const auto& include : includes_of(layer)) {
      for (const auto& rule : rules) {
        if (!starts_with_any(include.path, rule.heads)) continue;
        BOOST_TEST(layer == rule.layer, include.file << " includes " << include.path);
        // In a public header they would reach every layer above.
        BOOST_TEST(!(include.header && !include.internal), include.file << " includes " << include.path);
      }
    }
  }
}

BOOST_AUTO_TEST_CASE(internal_headers_stay_in_their_layer) {
  namespace fs = std::filesystem;
  for (const auto& layer : layers) {
    for (const auto& include : includes_of(layer)) {
      const fs::path path(include.path);
      const auto depth = std::distance(path.begin(), path.end());
      const std::string first = path.begin()->string();
      const bool ours = std::find(layers.begin(), layers.end(), first) != layers.end();
      if (ours && first != layer) BOOST_TEST(depth == 2, include.file << " reaches into " << include.path);
    }
  }
}

BOOST_AUTO_TEST_SUITE_END()

}  // namespace annulus
