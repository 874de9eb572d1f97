#include "app/model/reuse.h"

#include <fmt/format.h>

#include "app/model/run_options.h"
#include "app/results/program_identity.h"
#include "core/json.h"
#include "core/result_store.h"

namespace annulus::app {

void Reuse::note(const std::string& result, ResultSource source) {
  const std::lock_guard guard(lock_);
  const auto [entry, first] = results_.emplace(result, source);
  // Computed in this run and read back later on: it was computed.
  if (!first && source == ResultSource::computed) entry->second = source;
}

void Reuse::count(const std::string& things, long reused, long computed) {
  if (reused == 0 && computed == 0) return;
  const std::lock_guard guard(lock_);
  counts_[things].reused += reused;
  counts_[things].computed += computed;
}

std::vector<std::string> Reuse::list(ResultSource source) const {
  const std::lock_guard guard(lock_);
  std::vector<std::string> names;
  for (const auto& [name, own] : results_)
    if (own == source) names.push_back(name);
  return names;
}

Reuse::Count Reuse::counted(const std::string& things) const {
  const std::lock_guard guard(lock_);
  const auto found = counts_.find(things);
  return found == counts_.end() ? Count{} : found->second;
}

std::map<std::string, Reuse::Count> Reuse::counts() const {
  const std::lock_guard guard(lock_);
  return counts_;
}

std::string Reuse::text() const {
  std::string text;
  for (const auto source : {ResultSource::reused, ResultSource::computed}) {
    const bool of_reused = source == ResultSource::reused;
    std::string line;
    const auto add = [&](const std::string& part) { line += (line.empty() ? "" : ", ") + part; };
    for (const auto& name : list(source)) add(name);
    for (const auto& [things, count] : counts()) {
      const long n = of_reused ? count.reused : count.computed;
      if (n > 0) add(fmt::format("{} {}", n, things));
    }
    if (!line.empty()) text += (of_reused ? "reused   " : "computed ") + line + "\n";
  }
  return text;
}

Json Reuse::json() const {
  Json json = {{"reused", reused()}, {"computed", computed()}};
  json["counts"] = Json::object();
  for (const auto& [things, count] : counts())
    json["counts"][things] = {{"reused", count.reused}, {"computed", count.computed}};
  return json;
}

void note_reuse(const RunOptions& options, const std::string& result, ResultSource source) {
  if (options.reuse && !options.for_study) options.reuse->note(result, source);
}

void count_reuse(const RunOptions& options, const std::string& things, long reused, long computed) {
  if (options.reuse) options.reuse->count(things, reused, computed);
}

RunOptions with_reuse(const RunOptions& options) {
  RunOptions result = options;
  if (!result.reuse) result.reuse = std::make_shared<Reuse>();
  if (!result.store)
    result.store =
        std::make_shared<ResultStore>(result.cache.empty() ? result.out / "cache" : result.cache, program_identity());
  return result;
}

}  // namespace annulus::app
