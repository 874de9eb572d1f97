#include "tests/random/scene_run.h"

#include <fmt/format.h>
#include <sys/wait.h>

#include <algorithm>
#include <csignal>
#include <cstdlib>
#include <nlohmann/json.hpp>
#include <sstream>

#include "core/files.h"

namespace annulus::random {

namespace {

using Json = nlohmann::json;

/// Of the program (app/cli.h), and of timeout(1) and a shell when the program was ended by a signal.
Outcome outcome_of(int raw) {
  if (!WIFEXITED(raw)) return Outcome::crashed;
  switch (WEXITSTATUS(raw)) {
    case 0:
      return Outcome::right;
    case 2:
      return Outcome::refused;
    case 3:
      return Outcome::failed;
    case 4:
      return Outcome::over_limit;
    case 128 + SIGKILL:
      return Outcome::timed_out;
    default:
      return Outcome::crashed;
  }
}

double number(const Json& json, const char* key) {
  return json.contains(key) && json[key].is_number() ? json[key].get<double>() : not_known;
}

StatedResult stated(const std::string& variant, const std::string& key, const Json& json) {
  StatedResult result{.variant = variant, .key = key, .value = number(json, "value"), .error = number(json, "error")};
  // The only result whose error is that of the motion alone, and has no parts.
  if (key.ends_with("contact_loss")) result.motion_error = result.error;
  if (!json.contains("error_parts")) return result;
  result.model_error = number(json["error_parts"], "model_choice");
  result.motion_error = number(json["error_parts"], "time_integration");
  return result;
}

/// Lists of natural frequencies, wherever they stand: those of a variant below an object with its name.
void frequencies(const Json& json, const std::string& variant, std::vector<StatedResult>& results) {
  if (json.is_array()) {
    for (const auto& item : json) frequencies(item, variant, results);
    return;
  }
  if (!json.is_object()) return;
  const std::string name =
      json.contains("name") && json["name"].is_string() ? json["name"].get<std::string>() : variant;
  for (const auto& [key, value] : json.items()) {
    if (key != "natural_frequencies_Hz" || !value.is_array()) {
      frequencies(value, name, results);
      continue;
    }
    int order = 0;
    for (const auto& frequency : value)
      if (frequency.is_object())
        results.push_back(stated(name, fmt::format("natural_frequency_{}", ++order), frequency));
  }
}

/// What bash writes about a command: user and system time.
double processor_seconds(const std::filesystem::path& file) {
  std::istringstream times(read_file(file));
  double user = 0, system = 0;
  times >> user >> system;
  return times ? user + system : not_known;
}

void read_summary(const std::filesystem::path& file, SceneRun& run) {
  const auto json = Json::parse(read_file(file));
  for (const auto& variant : json.at("variants"))
    for (const auto& [key, figure] : variant.at("figures").items())
      run.results.push_back(stated(variant.at("name").get<std::string>(), key, figure));
  frequencies(json, "", run.results);
  run.cost.actual_MB = number(json, "peak_memory_MB");
  if (!json.contains("cost")) return;
  run.cost.predicted_seconds = number(json["cost"], "predicted_s");
  run.cost.predicted_MB = number(json["cost"], "predicted_peak_MB");
}

}  // namespace

const char* outcome_text(Outcome outcome) {
  switch (outcome) {
    case Outcome::right:
      return "right";
    case Outcome::refused:
      return "refused";
    case Outcome::too_expensive:
      return "too expensive";
    case Outcome::over_limit:
      return "over the limit";
    case Outcome::failed:
      return "failed";
    case Outcome::crashed:
      return "crashed";
    case Outcome::timed_out:
      return "timed out";
  }
  return "";
}

const StatedResult* SceneRun::find(const StatedResult& other) const {
  const auto found = std::find_if(results.begin(), results.end(), [&](const StatedResult& r) {
    return r.key == other.key && r.variant == other.variant;
  });
  return found == results.end() ? nullptr : &*found;
}

SceneRun run_scene(const std::string& toml, const std::filesystem::path& folder, const RunSettings& settings) {
  if (settings.fresh) std::filesystem::remove_all(folder);
  std::filesystem::create_directories(folder);
  write_file(folder / "scene.toml", toml);
  for (const auto& [name, text] : settings.files) write_file(folder / name, text);
  const std::string command = fmt::format(
      "cd '{}' && TIMEFORMAT='%U %S' && {{ time timeout --signal=KILL --foreground {} '{}' {} run scene.toml -o out "
      "--cache cache --max-time {} "
      ">stdout.txt 2>stderr.txt; }} 2>time.txt",
      folder.string(), settings.seconds, settings.program,
      settings.arguments.find("--threads") == std::string::npos ? "--threads 1 " + settings.arguments
                                                                : settings.arguments,
      settings.max_time);
  SceneRun run;
  run.outcome = outcome_of(std::system(fmt::format("bash -c \"{}\"", command).c_str()));
  if (run.outcome == Outcome::right) {
    read_summary(folder / "out" / "summary.json", run);
    run.cost.actual_seconds = processor_seconds(folder / "time.txt");
    return run;
  }
  run.message = read_file(folder / "stderr.txt");
  // The refusal of app/model/run_limits.cc, before anything is computed.
  if (run.outcome == Outcome::failed && run.message.find(": refused: predicted to ") != std::string::npos)
    run.outcome = Outcome::too_expensive;
  return run;
}

}  // namespace annulus::random
