#include "benchmarks/calculix/deck.h"

#include <fmt/format.h>

#include <cstdlib>
#include <fstream>
#include <sstream>

#include "benchmarks/stopwatch.h"

namespace annulus::benchmarks {

std::string deck_field(double value) { return fmt::format("{:.12g}", value); }

std::string spring_field(double value) { return fmt::format("{:.9e}", value); }

void write_equation(fmt::ostream& out, const DeckEquation& equation) {
  out.print("*EQUATION\n{}\n", equation.size());
  constexpr std::size_t per_line = 4;
  for (std::size_t i = 0; i < equation.size(); ++i)
    out.print("{}{}, {}, {}",
              i == 0              ? ""
              : i % per_line == 0 ? "\n"
                                  : ", ",
              equation[i].node, equation[i].component, deck_field(equation[i].factor));
  out.print("\n");
}

void write_body(fmt::ostream& out, const QuadraticBody& body, const std::string& name, int first_node, int first_cell) {
  out.print("*NODE\n");
  for (std::size_t i = 0; i < body.nodes.size(); ++i)
    out.print("{}, {}, {}, 0\n", first_node + i + 1, deck_field(body.nodes[i].x() / deck_mm),
              deck_field(body.nodes[i].y() / deck_mm));
  out.print("*ELEMENT, TYPE=CPE8, ELSET={}\n", name);
  for (std::size_t i = 0; i < body.cells.size(); ++i) {
    out.print("{}", first_cell + i + 1);
    for (const int node : body.cells[i]) out.print(", {}", first_node + node + 1);
    out.print("\n");
  }
}

void write_material(fmt::ostream& out, const fem::Material& material, const std::vector<std::string>& parts) {
  out.print("*MATERIAL, NAME=steel\n*ELASTIC\n{}, {}\n", deck_field(material.youngs_modulus / deck_MPa),
            deck_field(material.poisson_ratio));
  for (const auto& part : parts) out.print("*SOLID SECTION, ELSET={}, MATERIAL=steel\n{}\n", part, slice_width);
}

void write_interaction(fmt::ostream& out, double contact_stiffness) {
  out.print("*SURFACE INTERACTION, NAME=flanks\n*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=LINEAR\n{}\n",
            deck_field(contact_stiffness / deck_MPa * deck_mm));
}

std::vector<std::map<int, Eigen::Vector2d>> read_displacements(const std::filesystem::path& file,
                                                               const std::string& set) {
  std::ifstream in(file);
  std::vector<std::map<int, Eigen::Vector2d>> steps;
  std::string line;
  bool wanted = false;
  const std::string any = "for set ", heading = any + set + " and time";
  while (std::getline(in, line)) {
    if (line.find(any) != std::string::npos) {
      const auto found = line.find(heading);
      wanted = found != std::string::npos &&
               std::stod(line.substr(found + heading.size())) == static_cast<double>(steps.size() + 1);
      if (wanted) steps.emplace_back();
      continue;
    }
    int node = 0;
    double x = 0, y = 0;
    std::istringstream row(line);
    if (wanted && row >> node >> x >> y) steps.back()[node] = {x, y};
  }
  return steps;
}

DeckRun run_deck(const std::filesystem::path& folder, int threads) {
  const std::string command =
      fmt::format("cd '{}' && OMP_NUM_THREADS={} ccx job > job.log 2>&1", folder.string(), threads);
  DeckRun result;
  const Stopwatch watch;
  const int status = std::system(command.c_str());
  result.wall_seconds = watch.wall();
  result.cpu_seconds = watch.cpu();
  std::ifstream log(folder / "job.log");
  std::string line;
  while (std::getline(log, line)) {
    if (line.find("iteration") == 1) ++result.iterations;
    if (line.find("*ERROR") != std::string::npos && result.failure.empty()) result.failure = line;
  }
  if (result.failure.empty() && status != 0)
    result.failure = "ccx did not finish, see " + (folder / "job.log").string();
  return result;
}

}  // namespace annulus::benchmarks
