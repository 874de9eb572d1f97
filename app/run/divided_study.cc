#include "app/run/divided_study.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <set>
#include <sstream>
#include <utility>

#include "app/model/gear_system.h"
#include "app/model/system_run.h"
#include "app/plan/cost_plan.h"
#include "app/results/content_id.h"
#include "app/results/program_identity.h"
#include "app/results/result_folder.h"
#include "app/run/finished_run.h"
#include "app/run/study_scripts.h"
#include "app/scene/scene_files.h"
#include "app/study/study_parts.h"
#include "core/csv.h"
#include "core/errors.h"
#include "core/file_lock.h"
#include "core/files.h"
#include "core/result_store.h"

namespace annulus::app {

namespace {

namespace fs = std::filesystem;

constexpr const char *scene_name = "scene.toml", *points_name = "points.csv", *done_kind = "parts";
constexpr std::uintmax_t without_limit = UINTMAX_MAX;

fs::path packs_of(const fs::path& folder) { return folder / "packs"; }

fs::path pack_of(const fs::path& folder, const Worker& worker) {
  return packs_of(folder) / fmt::format("{}_of_{}", worker.number, worker.count);
}

/// The packs of all workers, sorted.
std::vector<fs::path> packs(const fs::path& folder) {
  std::vector<fs::path> list;
  std::error_code none;
  for (fs::directory_iterator pack(packs_of(folder), none), end; !none && pack != end; pack.increment(none))
    if (pack->is_directory()) list.push_back(pack->path());
  std::sort(list.begin(), list.end());
  return list;
}

Scene planned_scene(const fs::path& folder) {
  if (!fs::exists(folder / scene_name) || !fs::exists(folder / points_name))
    throw InputError(fmt::format("{}: holds no planned study; make one with: annulus study plan SCENE -o {}",
                                 folder.string(), folder.string()));
  return read_scene(folder / scene_name);
}

/// Names of parts: those that a worker has computed stand in its pack, one per line.
std::string name_of(const StudyPart& part) { return part.study + ": " + part.description; }

std::string id_of(const Scene& scene) { return run_id(scene, {}); }

/// The names of the parts that any worker has computed.
std::set<std::string> computed_parts(const ResultStore& store, const std::string& scene_id) {
  auto texts = store.find_others(done_kind, scene_id);
  texts.push_back(store.find_own(done_kind, scene_id).value_or(""));
  std::set<std::string> names;
  for (const auto& text : texts) {
    std::istringstream stream(text);
    for (std::string line; std::getline(stream, line);) names.insert(line);
  }
  return names;
}

/// A line per part.
std::string points_csv(const std::vector<StudyPart>& parts, const std::vector<std::vector<std::size_t>>& by_worker) {
  std::vector<std::string> worker(parts.size(), "all");
  for (std::size_t i = 0; i < by_worker.size(); ++i)
    for (const std::size_t place : by_worker[i])
      if (parts[place].workers == 1) worker[place] = std::to_string(i + 1);
  std::string text = fmt::format("# annulus_version: {}\npart,predicted_s,shard_of_{},study,description\n", version(),
                                 by_worker.size());
  for (std::size_t i = 0; i < parts.size(); ++i)
    text += fmt::format("{},{:.6g},{},{},{}\n", i + 1, parts[i].seconds, worker[i], csv_cell(parts[i].study),
                        csv_cell(parts[i].description));
  return text;
}

/// Files of the scene, which go along with it.
std::vector<std::string> files_of(const Scene& scene) {
  auto files = input_files(scene);
  if (scene.reference) files.push_back(*scene.reference);
  for (const auto& name : files)
    if (fs::path(name).is_relative() && fs::path(name).lexically_normal().string().starts_with(".."))
      throw InputError(
          fmt::format("{}: names {}, which lies outside its folder; a study on many machines takes the "
                      "files with it: put it beside the scene or give its whole path",
                      scene.file.string(), name));
  return files;
}

void write_script(const fs::path& file, const std::string& text) {
  write_file(file, text);
  fs::permissions(file, fs::perms::owner_exec | fs::perms::group_exec | fs::perms::others_exec, fs::perm_options::add);
}

/// The scene's own results, which every worker needs: one of them computes, the others wait and find them.
std::shared_ptr<SystemRun> own_results(const Scene& scene, const fs::path& folder, const RunOptions& given) {
  RunOptions options = given;
  options.store = std::make_shared<ResultStore>(folder / "cache", program_identity(), without_limit, packs(folder));
  const FileLock lock(folder / "cache.lock");
  auto run = std::make_shared<SystemRun>(scene);
  run->plan = run->system->plan(options.threads);
  fs::create_directories(options.out);
  run->solve_meshes(options);
  run->respond(options);
  return run;
}

}  // namespace

void refuse_planned_study(const fs::path& out) {
  if (fs::exists(out / points_name) && fs::exists(out / scene_name))
    throw InputError(
        fmt::format("--out {}: holds a planned study, whose results annulus study collect writes; use another folder",
                    out.string()));
}

Worker worker_of(const std::string& text) {
  Worker worker;
  const char* end = text.data() + text.size();
  const auto [slash, error] = std::from_chars(text.data(), end, worker.number);
  const bool halved = error == std::errc{} && slash != end && *slash == '/';
  const auto [rest, other] =
      halved ? std::from_chars(slash + 1, end, worker.count) : std::from_chars_result{end, error};
  constexpr int most = 100'000;
  if (!halved || other != std::errc{} || rest != end || worker.count < 1 || worker.count > most || worker.number < 1 ||
      worker.number > worker.count)
    throw InputError(
        fmt::format("--shard {}: is not the number of a worker and how many there are, as 1/8 to 8/8 (at "
                    "most {} workers)",
                    text, most));
  return worker;
}

std::string plan_study(const Scene& scene, const fs::path& folder, int workers) {
  const auto parts = study_parts(scene);
  if (parts.empty())
    throw InputError(
        fmt::format("{}: has no studies to divide: no [[sweep]], [[grid]], [load_spectrum], [[transient]], "
                    "[monte_carlo], [sensitivity] or [optimise]",
                    scene.file.string()));
  if (fs::exists(folder / "run.json"))
    throw InputError(fmt::format("--out {}: holds the results of a run; use another folder", folder.string()));
  const auto files = files_of(scene);
  // More workers would have nothing to do.
  std::size_t at_work = 0;
  double all = 0;
  for (const auto& part : parts) {
    at_work += static_cast<std::size_t>(part.workers);
    if (std::isfinite(part.seconds)) all += part.seconds;
  }
  const int shards = static_cast<int>(std::min(static_cast<std::size_t>(workers), at_work));
  const double longest = longest_share(parts, shards);
  const auto system = make_system(scene);
  auto own = system->plan(1).cost;
  std::erase_if(own.steps, [](const CostStep& step) { return step.kind == CostKind::studies; });
  const double first = own.seconds(), pace = own.pace;

  ResultFolder guard(folder, {scene.file, scene.title},
                     {folder / "cache", folder / "packs", folder / "results", folder / "logs"});
  guard.check();
  guard.begin();
  write_file(folder / scene_name, scene.text);
  for (const auto& name : files) {
    if (fs::path(name).is_absolute()) continue;
    fs::create_directories((folder / name).parent_path());
    write_file(folder / name, read_file(scene.file.parent_path() / name));
  }
  write_file(folder / points_name, points_csv(parts, shares(parts, shards)));
  write_script(folder / "study.sh", parallel_script(shards));
  write_script(folder / "study.sbatch", slurm_script(folder, shards, first + pace * longest, own.peak_MB()));
  fs::create_directories(folder / "logs");

  std::string text = fmt::format("{}: {} parts for {} workers\n", scene.title, parts.size(), shards);
  std::set<std::string> studies;
  for (const auto& part : parts)
    if (studies.insert(part.study).second) {
      const auto count =
          std::count_if(parts.begin(), parts.end(), [&](const auto& p) { return p.study == part.study; });
      text += fmt::format("  {:18} {:6} part{}\n", part.study, count, count == 1 ? "" : "s");
    }
  const auto here = folder.string();
  return text +
         fmt::format(
             "predicted  {} for the scene itself, once; {} of processor time for the parts, {} for the longest worker\n"
             "here       {}/study.sh              with GNU parallel, and collects\n"
             "cluster    sbatch {}/study.sbatch   then: annulus study collect {}\n"
             "by hand    annulus study run {} --shard 1/{} ... {}/{}, then: annulus study collect {}\n",
             duration_text(first), duration_text(pace * all), duration_text(pace * longest), here, here, here, here,
             shards, shards, shards, here);
}

std::string run_shard(const fs::path& folder, const Worker& worker, const RunOptions& given) {
  const auto scene = planned_scene(folder);
  const auto parts = study_parts(scene);
  const auto mine = shares(parts, worker.count)[static_cast<std::size_t>(worker.number - 1)];
  const auto pack = pack_of(folder, worker);
  fs::create_directories(pack);
  // With those that other workers are about to make.
  std::set<fs::path> others = {folder / "cache"};
  for (int i = 1; i <= worker.count; ++i) others.insert(pack_of(folder, {i, worker.count}));
  for (const auto& known : packs(folder)) others.insert(known);
  others.erase(pack);
  RunOptions options = given;
  options.out = pack / "files";
  options.cache = pack;
  options.worker = worker;
  options = with_reuse(options);
  options.store = std::make_shared<ResultStore>(pack, program_identity(), without_limit,
                                                std::vector<fs::path>(others.begin(), others.end()));
  const auto scene_id = id_of(scene);
  const auto known = computed_parts(*options.store, scene_id);
  std::vector<std::size_t> open;
  for (const std::size_t place : mine)
    if (!known.contains(name_of(parts[place]))) open.push_back(place);
  const auto done = mine.size() - open.size();
  if (!open.empty()) {
    const auto run = own_results(scene, folder, options);
    std::string own = options.store->find_own(done_kind, scene_id).value_or("");
    compute_parts(StudySubject(*run, options), open, [&](const std::vector<std::size_t>& places) {
      for (const std::size_t place : places) own += name_of(parts[place]) + "\n";
      options.store->keep(done_kind, scene_id, own);
    });
    fs::remove_all(options.out);
  }
  const auto of_searches = options.reuse->counted(search_evaluations).computed;
  return fmt::format("shard {}/{}: {} parts computed{}{}\n", worker.number, worker.count, open.size(),
                     of_searches > 0 ? fmt::format(", with {} points of searches", of_searches) : "",
                     done > 0 ? fmt::format("; {} were done before", done) : "");
}

Collected collect_study(const fs::path& folder, const RunOptions& given) {
  Collected collected{planned_scene(folder), given};
  const auto& scene = collected.scene;
  auto& options = collected.options;
  options.out = folder / "results";
  options.cache = folder / "cache";
  options.times = Times::left_out;
  options.store = std::make_shared<ResultStore>(options.cache, program_identity(), without_limit, packs(folder));
  const auto parts = study_parts(scene);
  const auto known = computed_parts(*options.store, id_of(scene));
  std::vector<std::size_t> missing;
  for (std::size_t i = 0; i < parts.size(); ++i)
    if (!known.contains(name_of(parts[i]))) missing.push_back(i);
  if (!missing.empty()) {
    const auto& first = parts[missing.front()];
    throw Error(
        fmt::format("{}: {} of {} parts are missing, the first one is {}: {}; run its workers again (annulus "
                    "study run {} --shard 1/1 computes all that is missing)",
                    folder.string(), missing.size(), parts.size(), first.study, first.description, folder.string()));
  }
  return collected;
}

}  // namespace annulus::app
