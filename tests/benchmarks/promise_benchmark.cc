// Is a wanted accuracy kept, and what does it cost beyond the cheapest setting that would have done?
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <exception>

#include "app/scene.h"
#include "app/trade_report.h"
#include "app/tradeoff.h"
#include "core/log.h"
#include "tests/benchmarks/promise/scenes.h"

namespace annulus::benchmark {
namespace {

using app::MeshSetting;
using fem::Rung;

constexpr double accuracies[] = {0.1, 0.03, 0.01, 0.003};

/// The fixed settings among which the cheapest is looked for, and the truth.
std::vector<MeshSetting> settings(const app::MeshModel&, bool needs_solid) {
  std::vector<MeshSetting> list;
  const auto add = [&](Rung rung, int degree, int level, int phases, std::vector<int> loads) {
    for (const int count : loads)
      list.push_back({.rung = rung, .degree = degree, .level = level, .phases = phases, .loads = count});
  };
  if (needs_solid) {
    for (const int phases : {16, 32, 64}) {
      add(Rung::solid, 1, 1, phases, {1, 3});
      add(Rung::solid, 2, 1, phases, {1, 3});
    }
    list.push_back({.rung = Rung::solid, .degree = 2, .level = 2, .phases = 64, .loads = 3, .finest = true});
    return list;
  }
  for (const int phases : {16, 32, 64, 128}) {
    add(Rung::closed_form, 2, 1, phases, {1, 3});
    add(Rung::plane, 1, 1, phases, {1, 3});
    if (phases == 16) continue;
    add(Rung::plane, 1, 2, phases, {3});
    add(Rung::plane, 2, 1, phases, {3});
    if (phases > 32) add(Rung::plane, 2, 2, phases, {3});
  }
  list.push_back({.rung = Rung::plane, .degree = 3, .level = 3, .phases = 256, .loads = 5, .finest = true});
  return list;
}

const app::TradePoint* cheapest(const app::RingTrade& ring, double accuracy) {
  const app::TradePoint* best = nullptr;
  for (const auto& p : ring.points) {
    if (p.part != app::TradePart::mesh || p.finest || p.planned_for || !(p.promised_error() <= accuracy)) continue;
    if (!best || p.cost.processor < best->cost.processor) best = &p;
  }
  return best;
}

}  // namespace
}  // namespace annulus::benchmark

int main(int argc, char** argv) {
  using namespace annulus;
  CLI::App cli("The wanted accuracy against the true error, and its cost against the cheapest setting that meets it");
  std::vector<std::string> names;
  std::filesystem::path out = "promise";
  cli.add_option("--scenes", names, "Names of scenes; all without");
  cli.add_option("-o,--out", out, "Where measurements are kept");
  CLI11_PARSE(cli, argc, argv);
  try {
    log::set_level(log::Level::quiet);
    app::TradeLists lists;
    lists.accuracies.assign(std::begin(benchmark::accuracies), std::end(benchmark::accuracies));
    lists.mesh = benchmark::settings;
    lists.dynamics = [](const auto&, const auto&) { return std::vector<app::DynamicsSetting>(); };
    for (const auto& s : benchmark::promise_scenes()) {
      if (!names.empty() && std::find(names.begin(), names.end(), s.name) == names.end()) continue;
      const auto scene = app::parse_scene(s.text, s.name + ".toml");
      const auto trade = app::measure_tradeoff(scene, {.out = out / s.name, .threads = 1}, lists);
      app::write_tradeoff(trade, out / s.name);
      const auto& ring = trade.rings.front();
      for (const auto& p : ring.points) {
        if (p.part != app::TradePart::mesh) continue;
        fmt::print("{:12} {:12} {:40} {:7.2f} s {:7.2f} s {:.4f} |", s.name, p.rung, p.settings, p.cost.processor,
                   p.response.processor, p.promised_error());
        for (const auto& v : p.values) fmt::print(" {:.1e}({:.1e})", v.error, v.error_estimate);
        fmt::print(" {}\n", p.failure);
      }
      for (const double accuracy : benchmark::accuracies) {
        const auto* planned = ring.planned(accuracy);
        const auto* best = benchmark::cheapest(ring, accuracy);
        fmt::print("{:12} {:6} error {:.5f} cost {:.2f} cheapest {:.2f} {} {} ratio {:.2f}\n", s.name, accuracy,
                   planned->promised_error(), planned->cost.processor, best ? best->cost.processor : 0,
                   best ? best->rung : "", best ? best->settings : "",
                   best ? planned->cost.processor / best->cost.processor : 0);
      }
      std::fflush(stdout);
    }
  } catch (const std::exception& error) {
    fmt::print(stderr, "{}\n", error.what());
    return 1;
  }
  return 0;
}
