#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "tests/random/relations.h"

namespace annulus::random {

struct CampaignSettings {
  std::string program;           ///< annulus
  std::filesystem::path folder;  ///< of scenes and results; those of pairs that agree are removed
  std::uint64_t first_seed = 1;
  int scenes = 20;
  int jobs = 1;                          ///< pairs at once
  int seconds = 300;                     ///< of each run
  std::string max_time = "1h";           ///< predicted; more expensive scenes are left out
  std::vector<std::string> relations{};  ///< names; empty: all
  std::vector<std::string> systems{};    ///< kinds with the wanted model, "planetary, solid"; empty: all
  std::filesystem::path table{};         ///< file for the tables, written anew after every scene; empty: none
};

/// What came of the pairs of one relation, or of one system and model.
struct PairTally {
  int tried = 0, agreed = 0, disagreed = 0;
  std::map<Outcome, int> outcomes;  ///< of runs that were not right
};

/// How one result fares against its stated errors.
struct ResultTally {
  std::vector<double> effectivities;  ///< difference over the sum of the errors, of every pair
  [[nodiscard]] double coverage() const;
  [[nodiscard]] double quantile(double share) const;  ///< of the effectivities
};

struct CampaignResult {
  std::map<std::string, PairTally> relations, systems;                ///< by relation; by kind and wanted model
  std::map<std::string, std::map<std::string, ResultTally>> results;  ///< by relation and key
  std::vector<std::string> complaints;                                ///< what is wrong, with its seed
  std::vector<Cost> costs;
};

/// Runs the pairs of all relations on random scenes. A pair is complained about when its runs crash, run out of time,
/// or break a relation that holds always; coverage of errors is a matter of statistics.
[[nodiscard]] CampaignResult run_campaign(const CampaignSettings& settings);

/// Share of the values of each result that lie within the sum of their errors, without those of the model.
inline constexpr double wanted_coverage = 0.95;
/// Whether nothing failed, crashed or ran out of time, the relations hold that always do, and the coverage of every
/// result at one model is the wanted one, as far as so many values can say.
[[nodiscard]] bool passes(const CampaignResult& result);

/// The tables and complaints, as Markdown.
[[nodiscard]] std::string campaign_text(const CampaignResult& result);

}  // namespace annulus::random
