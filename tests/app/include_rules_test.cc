#include <algorithm>
#include <boost/test/unit_test.hpp>
#include <filesystem>
#include <fstream>
#include <map>
#include <regex>
#include <set>
#include <string>
#include <vector>

/// The rooms of the tree: who may include what (CONTRIBUTING.md).
namespace annulus {

namespace {

namespace fs = std::filesystem;

struct Include {
  fs::path file;      ///< "fem/contact/contact_body.h"
  fs::path path;      ///< as written: "geometry/gear.h", "gmsh.h"
  std::string layer;  ///< "fem"
  bool header = false;
};

const std::vector<std::string> layers = {"core", "geometry", "fem", "dynamics", "app"};

/// All #include lines of one layer.
std::vector<Include> includes_of(const std::string& layer) {
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
      includes.push_back({fs::relative(entry.path(), ANNULUS_SOURCE_DIR), match[1].str(), layer, extension == ".h"});
    }
  }
  return includes;
}

/// The layer that a path belongs to, empty for none of ours.
std::string layer_of(const fs::path& path) {
  const std::string first = path.begin()->string();
  return std::find(layers.begin(), layers.end(), first) != layers.end() && path.has_parent_path() ? first : "";
}

/// The first `depth` folders of a file's path, fewer where it lies higher.
fs::path room_of(const fs::path& file, int depth) {
  fs::path room;
  for (const auto& part : file.parent_path()) {
    if (depth-- == 0) break;
    room /= part;
  }
  return room;
}

bool starts_with_any(const std::string& text, const std::vector<std::string>& heads) {
  return std::any_of(heads.begin(), heads.end(), [&](const std::string& head) { return text.starts_with(head); });
}

using Graph = std::map<fs::path, std::map<fs::path, std::string>>;  // room -> included room -> one line that does it

/// A circle in the graph, as text; empty when there is none.
std::string circle_in(const Graph& graph) {
  std::set<fs::path> done;
  std::vector<fs::path> way;
  std::string found;
  const auto visit = [&](const auto& self, const fs::path& room) -> bool {
    if (const auto seen = std::find(way.begin(), way.end(), room); seen != way.end()) {
      for (auto step = seen; step != way.end(); ++step) {
        const auto& to = step + 1 == way.end() ? room : *(step + 1);
        found += "\n  " + graph.at(*step).at(to);
      }
      return true;
    }
    if (done.contains(room)) return false;
    way.push_back(room);
    if (const auto edges = graph.find(room); edges != graph.end())
      for (const auto& [to, line] : edges->second)
        if (self(self, to)) return true;
    way.pop_back();
    done.insert(room);
    return false;
  };
  for (const auto& [room, edges] : graph)
    if (visit(visit, room)) return found;
  return {};
}

/// What the rooms of a layer, taken `depth` folders deep, include of each other.
Graph rooms_of(const std::string& layer, int depth) {
  Graph graph;
  for (const auto& include : includes_of(layer)) {
    if (layer_of(include.path) != layer) continue;
    const auto from = room_of(include.file, depth), to = room_of(include.path, depth);
    if (from != to) graph[from].emplace(to, include.file.string() + " includes " + include.path.string());
  }
  return graph;
}

}  // namespace

BOOST_AUTO_TEST_SUITE(include_rules)

BOOST_AUTO_TEST_CASE(layers_see_only_what_lies_below) {
  const std::map<std::string, std::vector<std::string>> seen = {
      {"core", {}},
      {"geometry", {"core"}},
      {"fem", {"core", "geometry"}},
      {"dynamics", {"core", "geometry"}},
      {"app", {"core", "geometry", "fem", "dynamics"}},
  };
  for (const auto& layer : layers) {
    for (const auto& include : includes_of(layer)) {
      const auto included = layer_of(include.path);
      if (included.empty() || included == layer) continue;
      const auto& allowed = seen.at(layer);
      BOOST_TEST((std::find(allowed.begin(), allowed.end(), included) != allowed.end()),
                 include.file << " includes " << include.path);
    }
  }
}

BOOST_AUTO_TEST_CASE(rooms_do_not_include_each_other_in_a_circle) {
  constexpr int deepest = 5;
  for (const auto& layer : layers)
    for (int depth = 2; depth <= deepest; ++depth) {
      const auto circle = circle_in(rooms_of(layer, depth));
      BOOST_TEST(circle.empty(), layer << ", " << depth << " folders deep, in a circle:" << circle);
    }
}

BOOST_AUTO_TEST_CASE(rooms_of_the_application_see_only_what_lies_below) {
  // From bottom to top (CONTRIBUTING.md). Kinds of gear systems see what they share, not each other.
  const std::vector<fs::path> order = {"app/process",  "app/scene",   "app/results", "app/report",   "app/plan",
                                       "app/rexs",     "app/model",   "app/study",   "app/sections", "app/run",
                                       "app/tradeoff", "app/systems", "app/export",  "app/compare",  "app"};
  const auto place = [&](const fs::path& file) {
    return std::find(order.begin(), order.end(), room_of(file, 2)) - order.begin();
  };
  for (const auto& include : includes_of("app")) {
    if (layer_of(include.path) != "app") continue;
    BOOST_TEST(place(include.file) < std::ssize(order), include.file << " is in no room of this list");
    BOOST_TEST(place(include.path) <= place(include.file), include.file << " includes " << include.path);
    const auto own = room_of(include.file, 3), other = room_of(include.path, 3);
    if (own.string().starts_with("app/systems/") && other.string().starts_with("app/systems/"))
      BOOST_TEST((own == other || other == "app/systems/shared"), include.file << " includes " << include.path);
  }
}

BOOST_AUTO_TEST_CASE(a_circle_is_found) {
  Graph graph;
  graph["a"]["b"] = "a to b";
  graph["b"]["c"] = "b to c";
  BOOST_TEST(circle_in(graph).empty());
  graph["c"]["b"] = "c to b";
  BOOST_TEST(circle_in(graph) == "\n  b to c\n  c to b");
}

BOOST_AUTO_TEST_CASE(heavy_libraries_stay_in_their_layer) {
  struct Rule {
    std::string room;
    std::vector<std::string> heads;
    std::vector<std::string> rooms_that_show_it;  ///< in headers, which no other layer includes
  };
  const std::vector<Rule> rules = {
      {"fem/dealii", {"deal.II/"}, {"fem/dealii"}},
      {"fem", {"cholmod", "suitesparse/"}, {"fem/condensation"}},
      {"geometry/gmsh", {"gmsh"}, {}},
      {"dynamics/pagmo", {"pagmo/"}, {}},
      {"dynamics", {"sundials/", "cvode", "arkode", "kinsol", "nvector/", "sunmatrix/", "sunlinsol/"}, {}},
      {"app", {"toml++/", "CLI/"}, {"app/scene/toml"}},
  };
  for (const auto& layer : layers) {
    for (const auto& include : includes_of(layer)) {
      for (const auto& rule : rules) {
        if (!starts_with_any(include.path.string(), rule.heads)) continue;
        BOOST_TEST(include.file.string().starts_with(rule.room + "/"), include.file << " includes " << include.path);
        const bool shown = starts_with_any(include.file.string(), rule.rooms_that_show_it);
        BOOST_TEST((!include.header || shown), include.file << " includes " << include.path);
      }
    }
  }
}

BOOST_AUTO_TEST_CASE(what_is_loaded_when_needed_is_included_by_nobody_else) {
  for (const std::string room : {"geometry/gmsh/", "fem/dealii/", "dynamics/pagmo/"})
    for (const auto& layer : layers)
      for (const auto& include : includes_of(layer))
        if (include.path.string().starts_with(room))
          BOOST_TEST(include.file.string().starts_with(room), include.file << " includes " << include.path);
}

BOOST_AUTO_TEST_CASE(other_layers_include_what_fem_offers) {
  const std::set<fs::path> offered = {
      "fem", "fem/choice", "fem/closed_form", "fem/problem", "fem/problem/structures", "fem/ring"};
  for (const auto& layer : layers) {
    if (layer == "fem") continue;
    for (const auto& include : includes_of(layer))
      if (layer_of(include.path) == "fem")
        BOOST_TEST(offered.contains(include.path.parent_path()), include.file << " includes " << include.path);
  }
}

BOOST_AUTO_TEST_SUITE_END()

}  // namespace annulus
