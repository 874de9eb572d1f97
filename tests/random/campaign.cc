#include "tests/random/campaign.h"

#include <fmt/format.h>

#include <algorithm>
#include <boost/math/distributions/binomial.hpp>
#include <cmath>
#include <iostream>
#include <mutex>
#include <regex>

#include "core/files.h"
#include "core/parallel.h"

namespace annulus::random {

namespace {

/// What the program says last.
std::string last_line(std::string message) {
  while (!message.empty() && message.back() == '\n') message.pop_back();
  return message.substr(message.rfind('\n') + 1).substr(0, 300);
}

/// An empty list asks for all.
bool wanted(const std::vector<std::string>& names, const std::string& name) {
  return names.empty() || std::find(names.begin(), names.end(), name) != names.end();
}

std::string system_name(const RandomScene& scene) { return fmt::format("{}, {}", scene.kind, scene.model); }

class Campaign {
 public:
  explicit Campaign(const CampaignSettings& settings) : settings_(settings) {
    for (const auto& relation : relations())
      if (wanted(settings.relations, relation.name)) relations_.push_back(&relation);
  }

  CampaignResult run() {
    for_each_task(static_cast<std::size_t>(settings_.scenes), settings_.jobs, [&](std::size_t i) {
      const auto scene = scene_of_campaign(settings_.first_seed + i);
      if (!wanted(settings_.systems, system_name(scene))) return;
      for (const auto* relation : relations_)
        if (const auto pair = pair_of(*relation, scene)) run_pair(scene, *relation, *pair);
      write_table();
    });
    std::sort(result_.complaints.begin(), result_.complaints.end());
    write_table();
    return std::move(result_);
  }

 private:
  void write_table() {
    const std::lock_guard lock(mutex_);
    if (!settings_.table.empty()) write_file(settings_.table, campaign_text(result_));
  }

  SceneRun run_one(const RandomScene& scene, const std::string& toml, const std::filesystem::path& folder,
                   const std::string& arguments, bool fresh) {
    return run_scene(toml, folder,
                     {settings_.program, arguments, settings_.seconds, fresh, settings_.max_time, scene.files});
  }

  void run_pair(const RandomScene& scene, const Relation& relation, const RunPair& pair) {
    auto name = fmt::format("{}-{}", scene.seed, relation.name);
    std::replace(name.begin(), name.end(), ' ', '_');
    const auto folder = settings_.folder / name;
    const auto first = run_one(scene, pair.first, folder / "first", pair.first_arguments, true);
    SceneRun second;
    if (first.outcome == Outcome::right)
      second = run_one(scene, pair.second, pair.second_reuses ? folder / "first" : folder / "second",
                       pair.second_arguments, !pair.second_reuses);
    if (pair.second_reuses) second.cost = {};  // what was reused is no measure of a prediction
    const bool keep = note(scene, relation, first, second);
    if (!keep) std::filesystem::remove_all(folder);
  }

  /// Whether the pair is worth looking at.
  bool note(const RandomScene& scene, const Relation& relation, const SceneRun& first, const SceneRun& second) {
    const std::lock_guard lock(mutex_);
    PairTally* const tallies[] = {&result_.relations[relation.name], &result_.systems[system_name(scene)]};
    for (auto* tally : tallies) ++tally->tried;
    for (const auto* run : {&first, &second}) {
      if (run->outcome == Outcome::right) {
        result_.costs.push_back(run->cost);
        result_.costs.back().seed = scene.seed;
        continue;
      }
      for (auto* tally : tallies) ++tally->outcomes[run->outcome];
      if (run->outcome == Outcome::refused || run->outcome == Outcome::too_expensive ||
          run->outcome == Outcome::over_limit)
        return false;
      complain(scene, relation, fmt::format("{}: {}", outcome_text(run->outcome), last_line(run->message)));
      return true;
    }
    std::string worst;
    double largest = 1;
    for (const auto& r : compared(relation, first, second)) {
      static const std::regex order("_[0-9]+$");  // all natural frequencies are one result
      result_.results[relation.name][std::regex_replace(r.key, order, "")].effectivities.push_back(r.effectivity());
      if (r.effectivity() <= largest) continue;
      largest = r.effectivity();
      worst = fmt::format("{}: {} and {}, allowed difference {:.2g}, {:.3g} times that", r.key, r.first, r.second,
                          r.allowed, largest);
    }
    for (auto* tally : tallies) ++(worst.empty() ? tally->agreed : tally->disagreed);
    if (worst.empty()) return false;
    complain(scene, relation, worst);
    return true;
  }

  void complain(const RandomScene& scene, const Relation& relation, const std::string& what) {
    result_.complaints.push_back(
        fmt::format("seed {} ({}, {}), {}: {}", scene.seed, scene.kind, scene.model, relation.name, what));
    std::cerr << result_.complaints.back() << std::endl;
  }

  const CampaignSettings& settings_;
  std::vector<const Relation*> relations_;
  std::mutex mutex_;
  CampaignResult result_;
};

double quantile_of(std::vector<double> list, double share) {
  if (list.empty()) return not_known;
  std::sort(list.begin(), list.end());
  return list[static_cast<std::size_t>(share * static_cast<double>(list.size() - 1) + 0.5)];
}

std::string cost_text(const std::vector<Cost>& costs, const char* name, double Cost::*predicted, double Cost::*actual,
                      double smallest) {
  std::vector<double> ratios;
  std::uint64_t worst = 0;
  for (const auto& cost : costs) {
    if (!(cost.*predicted > 0 && std::max(cost.*actual, cost.*predicted) > smallest)) continue;
    const double ratio = cost.*actual / cost.*predicted;
    if (ratios.empty() || ratio > *std::max_element(ratios.begin(), ratios.end())) worst = cost.seed;
    ratios.push_back(ratio);
  }
  if (ratios.empty()) return "";
  const auto near =
      std::count_if(ratios.begin(), ratios.end(), [](double ratio) { return ratio >= 0.5 && ratio <= 2; });
  return fmt::format("| {} | {} | {:.2f} | {:.2f} | {:.2f} | {:.2f} | {:.2f} | {} | {:.0f} % |\n", name, ratios.size(),
                     quantile_of(ratios, 0), quantile_of(ratios, 0.05), quantile_of(ratios, 0.5),
                     quantile_of(ratios, 0.95), quantile_of(ratios, 1), worst,
                     100.0 * static_cast<double>(near) / static_cast<double>(ratios.size()));
}

}  // namespace

double ResultTally::coverage() const {
  const auto within = std::count_if(effectivities.begin(), effectivities.end(), [](double e) { return e <= 1; });
  return static_cast<double>(within) / static_cast<double>(effectivities.size());
}
double ResultTally::quantile(double share) const { return quantile_of(effectivities, share); }

CampaignResult run_campaign(const CampaignSettings& settings) { return Campaign(settings).run(); }

bool passes(const CampaignResult& result) {
  for (const auto& relation : relations()) {
    const auto tally = result.relations.find(relation.name);
    if (tally == result.relations.end()) continue;
    for (const auto outcome : {Outcome::crashed, Outcome::timed_out, Outcome::failed})
      if (tally->second.outcomes.contains(outcome)) return false;
    const bool statistical =
        relation.agreement == Agreement::errors || relation.agreement == Agreement::numerical_errors;
    if (!statistical && tally->second.disagreed > 0) return false;
    const auto results = result.results.find(relation.name);
    if (relation.agreement != Agreement::numerical_errors || results == result.results.end()) continue;
    for (const auto& [key, values] : results->second) {
      // So many outside would happen by chance in one of 44 cases (two standard deviations), or more often.
      const auto count = static_cast<double>(values.effectivities.size());
      const double outside = std::round((1 - values.coverage()) * count);
      const boost::math::binomial_distribution<double> chance(count, 1 - wanted_coverage);
      if (outside > 0 && boost::math::cdf(boost::math::complement(chance, outside - 1)) < 1.0 / 44) return false;
    }
  }
  return true;
}

namespace {

std::string tally_table(const char* of, const std::map<std::string, PairTally>& tallies) {
  std::string text = fmt::format(
      "| {} | tried | agree | differ | refused | too expensive | over the limit | failed | crashed | timed out |\n"
      "|---|---|---|---|---|---|---|---|---|---|\n",
      of);
  for (const auto& [name, tally] : tallies) {
    text += fmt::format("| {} | {} | {} | {} |", name, tally.tried, tally.agreed, tally.disagreed);
    for (const auto outcome : {Outcome::refused, Outcome::too_expensive, Outcome::over_limit, Outcome::failed,
                               Outcome::crashed, Outcome::timed_out}) {
      const auto found = tally.outcomes.find(outcome);
      text += fmt::format(" {} |", found == tally.outcomes.end() ? 0 : found->second);
    }
    text += "\n";
  }
  return text;
}

}  // namespace

std::string campaign_text(const CampaignResult& result) {
  std::string text =
      tally_table("relation", result.relations) + "\n" + tally_table("system, wanted model", result.systems);
  for (const auto& [relation, results] : result.results) {
    text += fmt::format(
        "\n{}: difference over what is allowed\n\n| result | values | within | median | 95 % | largest |\n"
        "|---|---|---|---|---|---|\n",
        relation);
    for (const auto& [key, tally] : results)
      text += fmt::format("| {} | {} | {:.1f} % | {:.2g} | {:.2g} | {:.3g} |\n", key, tally.effectivities.size(),
                          100 * tally.coverage(), tally.quantile(0.5), tally.quantile(0.95), tally.quantile(1));
  }
  text +=
      "\n| actual over predicted | runs | least | 5 % | median | 95 % | largest | its seed | within "
      "a factor of 2 |\n|---|---|---|---|---|---|---|---|---|\n";
  text += cost_text(result.costs, "time, of runs above 1 s", &Cost::predicted_seconds, &Cost::actual_seconds, 1);
  text += cost_text(result.costs, "memory", &Cost::predicted_MB, &Cost::actual_MB, 0);
  if (!result.complaints.empty()) text += "\n";
  for (const auto& complaint : result.complaints) text += "- " + complaint + "\n";
  return text;
}

}  // namespace annulus::random
