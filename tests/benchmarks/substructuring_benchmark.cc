// Whole rings composed of one condensed sector against the monolithic solution of the same mesh. Every case runs in a
// process of its own, so that its peak memory is known.

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <optional>
#include <sstream>
#include <string>
#include <vector>

#include "benchmarks/stopwatch.h"
#include "benchmarks/substructuring/ring_case.h"

namespace {

using namespace annulus::benchmarks;

constexpr double accuracy = 1e-8;  // largest difference of the compliances, relative to the largest: round-off
constexpr int threads = 2;

/// What one process reports, as text with all digits.
struct Outcome {
  long unknowns = 0;
  double discretise = 0, condense = 0, compose = 0, cpu = 0, peak_MB = 0;
  std::vector<double> compliance{};
};

void run_here(const RingCase& ring, bool whole) {
  const auto r = whole ? monolithic(ring) : composed(ring, threads);
  fmt::print("{} {} {} {} {} {}\n", r.unknowns, r.discretise_seconds, r.condense_seconds, r.compose_seconds,
             r.cpu_seconds, peak_resident_MB());
  for (const auto& block : r.blocks)
    for (const double value : block.reshaped()) fmt::print("{}\n", value);
}

std::optional<Outcome> run_apart(const RingCase& ring, bool whole) {
  const std::string command =
      fmt::format("'{}' --case --teeth {} --dimension {} --level {} {} {}",
                  std::filesystem::read_symlink("/proc/self/exe").string(), ring.teeth, ring.dimension,
                  ring.level.value_or(-1), ring.cantilever ? "--cantilever" : "", whole ? "--monolithic" : "");
  FILE* pipe = popen(command.c_str(), "r");
  if (pipe == nullptr) return std::nullopt;
  std::string text;
  std::vector<char> buffer(1 << 16);
  for (std::size_t n = 0; (n = fread(buffer.data(), 1, buffer.size(), pipe)) > 0;) text.append(buffer.data(), n);
  if (pclose(pipe) != 0) return std::nullopt;
  std::istringstream in(text);
  Outcome o;
  in >> o.unknowns >> o.discretise >> o.condense >> o.compose >> o.cpu >> o.peak_MB;
  for (double value = 0; in >> value;) o.compliance.push_back(value);
  if (o.compliance.empty()) return std::nullopt;
  return o;
}

double largest_difference(const Outcome& a, const Outcome& b) {
  if (a.compliance.size() != b.compliance.size()) return 1;
  double difference = 0, largest = 0;
  for (std::size_t i = 0; i < a.compliance.size(); ++i) {
    difference = std::max(difference, std::abs(a.compliance[i] - b.compliance[i]));
    largest = std::max(largest, std::abs(b.compliance[i]));
  }
  return difference / largest;
}

void print_outcome(const RingCase& ring, const char* way, const Outcome& o) {
  fmt::print("{:<38} {:<10} {:>9} {:>9.2f} {:>9.2f} {:>9.3f} {:>9.2f} {:>9.2f} {:>8.0f}", describe(ring), way,
             o.unknowns, o.discretise, o.condense, o.compose, o.discretise + o.condense + o.compose, o.cpu, o.peak_MB);
}

/// Whether the case was computed and, when there are two results, they agree.
bool report(const RingCase& ring, bool with_monolithic) {
  const auto parts = run_apart(ring, false);
  if (!parts) {
    fmt::print("{}: FAILED\n", describe(ring));
    return false;
  }
  print_outcome(ring, "composed", *parts);
  fmt::print("\n");
  std::fflush(stdout);
  if (!with_monolithic) return true;
  const auto whole = run_apart(ring, true);
  if (!whole) {
    fmt::print("{}: monolithic FAILED\n", describe(ring));
    return false;
  }
  const double difference = largest_difference(*parts, *whole);
  print_outcome(ring, "monolithic", *whole);
  fmt::print("   {:.0f} times the processor time, {:.1f} times the memory, difference {:.1e}{}\n",
             whole->cpu / parts->cpu, whole->peak_MB / parts->peak_MB, difference,
             difference <= accuracy ? "" : " TOO LARGE");
  std::fflush(stdout);
  return difference <= accuracy;
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app{"Composed rings against monolithic ones: time, memory, difference of the compliance"};
  RingCase ring;
  int level = -1, largest_plane = 486, largest_solid = 54;
  bool one_case = false, whole = false;
  app.add_option("--largest-plane", largest_plane, "most teeth of a monolithic plane ring")->capture_default_str();
  app.add_option("--largest-solid", largest_solid, "most teeth of a monolithic solid ring")->capture_default_str();
  app.add_flag("--case", one_case, "run one case and print its figures as numbers");
  app.add_option("--teeth", ring.teeth);
  app.add_option("--dimension", ring.dimension);
  app.add_option("--level", level, "solid resolution of the program; -1: the coarse mesh of the comparison");
  app.add_flag("--cantilever", ring.cantilever, "held at the end face of a sleeve");
  app.add_flag("--monolithic", whole);
  CLI11_PARSE(app, argc, argv);
  if (one_case) {
    if (level >= 0) ring.level = level;
    run_here(ring, whole);
    return EXIT_SUCCESS;
  }

  fmt::print("{:<38} {:<10} {:>9} {:>9} {:>9} {:>9} {:>9} {:>9} {:>8}\n", "ring", "", "unknowns", "mesh s", "factor s",
             "compose s", "total s", "cpu s", "peak MB");
  bool good = true;
  for (const int dimension : {2, 3})
    for (const int teeth : {18, 54, 162, 486})
      good = report({teeth, dimension, false, {}}, teeth <= (dimension == 2 ? largest_plane : largest_solid)) && good;
  good = report({54, 3, true, {}}, true) && good;
  // The target: the ring of the ring paper as the program meshes it.
  for (const int program_level : {1, 2})
    for (const bool cantilever : {false, true}) good = report({162, 3, cantilever, program_level}, false) && good;
  return good ? EXIT_SUCCESS : EXIT_FAILURE;
}
