// Is a wanted accuracy kept, and what does it cost beyond the cheapest setting that would have done?
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <exception>
#include <filesystem>
#include <string>
#include <vector>

#include "app/process/measured_work.h"
#include "app/run/pipeline.h"
#include "app/scene/overrides.h"
#include "app/scene/scene.h"
#include "app/systems/planetary/planetary_input.h"
#include "app/systems/planetary/planetary_model.h"
#include "app/tradeoff/trade_report.h"
#include "app/tradeoff/tradeoff.h"
#include "core/errors.h"
#include "core/log.h"
#include "tests/benchmarks/promise/scenes.h"

namespace annulus::benchmark {
namespace {

using app::MeshSetting;
using fem::Fidelity;

constexpr double accuracies[] = {0.1, 0.03, 0.01, 0.003};

/// The fixed settings among which the cheapest is looked for, and the truth.
std::vector<MeshSetting> settings(app::AlongFace face) {
  std::vector<MeshSetting> list;
  const auto add = [&](Fidelity fidelity, int degree, int level, int phases, std::vector<int> loads) {
    for (const int count : loads)
      list.push_back({.fidelity = fidelity, .degree = degree, .level = level, .phases = phases, .loads = count});
  };
  if (face == app::AlongFace::varying) {
    for (const int phases : {32, 64}) {
      add(Fidelity::solid, 1, 1, phases, {1, 3});
      add(Fidelity::solid, 2, 1, phases, {1, 3});
    }
    list.push_back({.fidelity = Fidelity::solid, .degree = 2, .level = 2, .phases = 64, .loads = 3, .finest = true});
    return list;
  }
  for (const int phases : {16, 32, 64}) {
    add(Fidelity::closed_form, 2, 1, phases, {1, 3});
    add(Fidelity::plane, 1, 1, phases, {1, 3});
    if (phases == 16) continue;
    add(Fidelity::plane, 1, 2, phases, {3});
    add(Fidelity::plane, 2, 1, phases, {3});
    if (phases > 32) add(Fidelity::plane, 2, 2, phases, {3});
  }
  list.push_back({.fidelity = Fidelity::plane, .degree = 3, .level = 3, .phases = 512, .loads = 5, .finest = true});
  return list;
}

/// One scene at one wanted accuracy.
struct Row {
  std::string scene;
  double accuracy = 0;
  const app::VariantTrade* ring = nullptr;
  const app::TradePoint* planned = nullptr;
  const app::TradePoint* cheapest = nullptr;  ///< fixed setting by the time of its tables; nullptr: none meets it
  const app::TradePoint* known = nullptr;     ///< the cheapest that meets it and says so: the planner knows no luck
  double planned_run = 0, cheapest_run = 0, known_run = 0;  ///< s of processor time of a whole run

  [[nodiscard]] bool refused() const { return !planned->failure.empty(); }
  [[nodiscard]] bool kept() const { return ring->guaranteed_error(*planned) <= accuracy; }
};

const app::TradePoint* cheapest(const app::VariantTrade& ring, double accuracy, bool known) {
  const app::TradePoint* best = nullptr;
  for (const auto& p : ring.points) {
    if (!p.mesh || p.finest || !(ring.guaranteed_error(p) <= accuracy)) continue;
    if (known && !(ring.stiffness_estimate(p) <= accuracy)) continue;
    if (!best || p.cost.processor < best->cost.processor) best = &p;
  }
  return best;
}

/// Processor time that a program with the libraries of `annulus` takes before it does anything: part of every run,
/// whose work is measured in a process where they stand already. The middle one of several.
double start_time() {
  std::vector<double> times;
  for (int i = 0; i < 5; ++i) {
    const auto started = app::measured([] {
      const std::string self = std::filesystem::read_symlink("/proc/self/exe");
      return std::string(std::system(("'" + self + "' --help >/dev/null").c_str()) == 0 ? "" : "failed");
    });
    if (!started.answer.empty() || !started.failure.empty()) throw SolverError("this program does not start again");
    times.push_back(started.cost.processor);
  }
  std::nth_element(times.begin(), times.begin() + 2, times.end());
  return times[2];
}

/// Processor time of `annulus run` from scratch, as planned or with a fixed setting of the meshes; `start`: see above.
double run_time(const app::Scene& scene, const std::filesystem::path& folder, const app::MeshSetting* setting,
                double start) {
  app::RunOptions options{.out = folder, .threads = 1};
  if (setting)
    options.remodel = [&](const app::MeshModel& planned) {
      const bool solid = planned.variant.empty() ? !solid_reason(scene).empty()
                                                 : !solid_reason(scene, planetary(scene).rings.front()).empty();
      return setting->applied(planned, solid ? app::AlongFace::varying : app::AlongFace::uniform);
    };
  std::filesystem::remove_all(folder);
  const auto done = app::measured([&] {
    (void)app::run_system(scene, options);
    return std::string("done");
  });
  std::filesystem::remove_all(folder);
  return done.failure.empty() ? start + done.cost.processor : std::nan("");
}

void print_points(const std::string& scene, const app::VariantTrade& ring) {
  for (const auto& p : ring.points) {
    if (p.part != app::TradePart::mesh) continue;
    fmt::print("{:12} {:12} {:40} {:7.2f} s {:.5f} |", scene, p.fidelity, p.settings, p.cost.processor,
               ring.guaranteed_error(p));
    for (const auto& v : p.values) fmt::print(" {:.1e} ({:.1e})", v.error, v.error_estimate);
    fmt::print(" {}\n", p.failure);
  }
}

void print_row(const Row& row) {
  std::string text = fmt::format("{:12} {:>5} %", row.scene, fmt::format("{:g}", 100 * row.accuracy));
  if (row.refused()) {
    fmt::print("{}  refused: {}\n", text, row.planned->failure);
    return;
  }
  text +=
      fmt::format("  {:>8.3f} %  {}", 100 * row.ring->guaranteed_error(*row.planned), row.kept() ? "kept  " : "MISSED");
  if (row.planned_run > 0)
    text += fmt::format("  tables {:6.2f} s  run {:6.2f} s", row.planned->cost.processor, row.planned_run);
  if (row.cheapest)
    text += fmt::format("  cheapest {:6.2f} s {:6.2f} s ({}, {})  ratio {:5.2f} {:5.2f}", row.cheapest->cost.processor,
                        row.cheapest_run, row.cheapest->fidelity, row.cheapest->settings,
                        row.planned->cost.processor / row.cheapest->cost.processor, row.planned_run / row.cheapest_run);
  if (row.known && row.known != row.cheapest)
    text += fmt::format("; that says so {:6.2f} s {:6.2f} s ({}, {})  ratio {:5.2f} {:5.2f}", row.known->cost.processor,
                        row.known_run, row.known->fidelity, row.known->settings,
                        row.planned->cost.processor / row.known->cost.processor, row.planned_run / row.known_run);
  fmt::print("{}\n", text);
}

}  // namespace
}  // namespace annulus::benchmark

int main(int argc, char** argv) {
  using namespace annulus;
  CLI::App cli("The wanted accuracy against the true error, and its cost against the cheapest setting that meets it");
  std::vector<std::string> names;
  std::filesystem::path out = "promise";
  bool errors_only = false, verbose = false, fresh = false;
  cli.add_option("--scenes", names, "Names of scenes; all without");
  cli.add_option("-o,--out", out, "Where measurements are kept");
  cli.add_flag("--errors-only", errors_only, "Not the cost: no fixed settings");
  cli.add_flag("--fresh", fresh, "Forget what was measured before");
  cli.add_flag("--verbose", verbose, "Every setting and figure: error (estimate)");
  CLI11_PARSE(cli, argc, argv);
  try {
    log::set_level(log::Level::quiet);
    if (fresh) std::filesystem::remove_all(out);
    ::setenv("ANNULUS_CACHE", "", 1);  // predictions are not to depend on earlier runs, nor to learn from these
    app::TradeLists lists;
    lists.accuracies.assign(std::begin(benchmark::accuracies), std::end(benchmark::accuracies));
    lists.mesh = [errors_only](const app::MeshModel&, app::AlongFace face) {
      auto list = benchmark::settings(face);
      if (errors_only) list.erase(list.begin(), list.end() - 1);
      return list;
    };
    lists.motions = false;
    const double start = errors_only ? 0 : benchmark::start_time();
    int cases = 0, kept = 0, refused = 0, priced = 0, cheap = 0, known = 0, known_cheap = 0;
    fmt::print(
        "wanted and true error (largest of stiffness entries, mean stiffness, load sharing, natural frequencies and,\n"
        "while all teeth stay in contact, peak factors), processor time, and the cheapest fixed setting that meets\n"
        "the accuracy\n");
    if (!errors_only) fmt::print("runs: of it {:.2f} s for the start of the program\n", start);
    for (const auto& s : benchmark::promise_scenes()) {
      if (!names.empty() && std::find(names.begin(), names.end(), s.name) == names.end()) continue;
      const auto scene = app::parse_scene(s.text, s.name + ".toml");
      const auto trade = app::measure_tradeoff(scene, {.out = out / s.name, .threads = 1}, lists);
      app::write_tradeoff(trade, out / s.name);
      const auto& ring = trade.variants.front();
      if (verbose) benchmark::print_points(s.name, ring);
      for (const double accuracy : benchmark::accuracies) {
        benchmark::Row row{.scene = s.name, .accuracy = accuracy, .ring = &ring, .planned = ring.planned(accuracy)};
        ++cases;
        refused += row.refused();
        kept += !row.refused() && row.kept();
        if (!errors_only && !row.refused()) {
          const auto wanted = app::with_accuracy(scene, accuracy, "asked of the planner");
          row.cheapest = benchmark::cheapest(ring, accuracy, false);
          row.known = benchmark::cheapest(ring, accuracy, true);
          row.planned_run = benchmark::run_time(wanted, out / "run", nullptr, start);
          if (row.cheapest) {
            row.cheapest_run = benchmark::run_time(wanted, out / "run", &*row.cheapest->mesh, start);
            ++priced;
            cheap += row.planned_run <= 3 * row.cheapest_run;
          }
          if (row.known) {
            row.known_run = row.known == row.cheapest
                                ? row.cheapest_run
                                : benchmark::run_time(wanted, out / "run", &*row.known->mesh, start);
            ++known;
            known_cheap += row.planned_run <= 3 * row.known_run;
          }
        }
        benchmark::print_row(row);
        std::fflush(stdout);
      }
    }
    fmt::print("{} cases: {} kept, {} missed, {} refused", cases, kept, cases - kept - refused, refused);
    if (priced > 0)
      fmt::print("; {} of {} runs cost at most three times the cheapest, {} of {} the cheapest that says so", cheap,
                 priced, known_cheap, known);
    fmt::print("\n");
    return kept > 0 && kept >= 0.95 * (cases - refused) ? 0 : 1;
  } catch (const std::exception& error) {
    fmt::print(stderr, "{}\n", error.what());
    return 1;
  }
}
