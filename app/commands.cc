#include "app/commands.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <functional>

#include "app/compare/compared_run.h"
#include "app/compare/comparison_page.h"
#include "app/export/export.h"
#include "app/export/rexs.h"
#include "app/model/definitions.h"
#include "app/model/gear_system.h"
#include "app/model/run_limits.h"
#include "app/plan/plan.h"
#include "app/process/held_limits.h"
#include "app/report/page.h"
#include "app/results/figure_table.h"
#include "app/results/result_folder.h"
#include "app/results/user_cache.h"
#include "app/run/divided_study.h"
#include "app/run/finished_run.h"
#include "app/run/pipeline.h"
#include "app/scene/example_scenes.h"
#include "app/scene/json_schema.h"
#include "app/scene/new_scene.h"
#include "app/scene/overrides.h"
#include "app/scene/scene_files.h"
#include "app/scene/scene_schema.h"
#include "app/study/studies.h"
#include "app/tradeoff/trade_report.h"
#include "core/errors.h"
#include "core/files.h"
#include "core/json.h"
#include "core/log.h"
#include "core/result_store.h"

namespace annulus::app {

namespace {

std::filesystem::path cache_of(const Arguments& arguments, const std::filesystem::path& out) {
  return arguments.cache.empty() ? results_cache(out) : std::filesystem::path(arguments.cache);
}

RunOptions run_options(const Arguments& arguments, const Scene& scene) {
  RunOptions options{.threads = arguments.threads};
  options.command = arguments.command_line;
  options.out =
      arguments.out.empty() ? std::filesystem::path("out") / scene.file.stem() : std::filesystem::path(arguments.out);
  options.cache = cache_of(arguments, options.out);
  return options;
}

ResultFolder folder_of(const RunOptions& options, const Scene& scene) {
  refuse_planned_study(options.out);
  return {options.out, {scene.file, scene.title}, {options.cache, user_cache()}};
}

RunLimits limits_of(const Arguments& arguments) {
  auto limits = RunLimits::of_this_machine();
  if (arguments.max_memory) limits.memory_MB = parse_memory(*arguments.max_memory);
  if (arguments.max_time) limits.seconds = parse_duration(*arguments.max_time, "--max-time");
  return limits;
}

/// What the options ask for; the machine's own limits are held by the machine.
void hold(const Arguments& arguments, const RunOptions& options) {
  HeldLimits limits{.stored = options.cache.string()};
  if (arguments.max_memory) limits.memory_MB = parse_memory(*arguments.max_memory);
  if (arguments.max_time) limits.seconds = parse_duration(*arguments.max_time, "--max-time");
  hold_limits(limits);
}

/// Whether results can be written there, before anything is computed; makes nothing.
void check_out(const std::filesystem::path& out) {
  namespace fs = std::filesystem;
  fs::path there = fs::absolute(out).lexically_normal();
  std::error_code error;
  while (!fs::exists(fs::symlink_status(there, error)) && there.has_relative_path()) there = there.parent_path();
  if (fs::is_symlink(fs::symlink_status(there, error)) && !fs::exists(there, error))
    throw InputError(fmt::format("--out {}: {} is a link to {}, which does not exist", out.string(), there.string(),
                                 fs::read_symlink(there, error).string()));
  if (!fs::is_directory(there, error))
    throw InputError(fmt::format("--out {}: {} is not a folder", out.string(), there.string()));
  if (::access(there.c_str(), W_OK | X_OK) != 0)
    throw InputError(fmt::format("--out {}: cannot write in {}", out.string(), there.string()));
}

/// What can be known to be wrong before anything is computed; the run itself checks its studies first.
void check_scene(const Scene& scene, const Arguments& arguments, RunExtent extent = RunExtent::whole) {
  check_stage(scene);
  check_files(scene);
  check_limits(scene, limits_of(arguments), arguments.threads, extent);
}

/// The scene as the file has it, or as accurate as the budget allows; what that means goes into `sentence`.
Scene wanted_scene(const Arguments& arguments, std::string& sentence) {
  const double budget = arguments.budget ? parse_duration(*arguments.budget) : 0;
  Scene scene = read_scene_with(arguments.scene, arguments.settings);
  if (!arguments.budget) return scene;
  check_stage(scene);
  auto choice = fit_budget(scene, budget, arguments.threads);
  sentence = std::move(choice.sentence);
  return std::move(choice.scene);
}

/// Without the table of a run its warnings go to the messages; notes are in the summary alone.
void warn_of_results(const std::string& summary) {
  const auto json = Json::parse(summary);
  for (const auto& warning : json.at("warnings")) {
    if (warning.at("severity") == to_text(Severity::note)) continue;
    const std::string where = warning.value("where", "");
    log::warn((where.empty() ? "" : where + ": ") + warning.at("text").get<std::string>());
  }
}

/// `budget`: what was chosen for one; empty without.
void run_and_print(const Arguments& arguments, const Scene& scene, RunOptions options, const std::string& budget) {
  check_out(options.out);
  auto folder = folder_of(options, scene);
  options.folder = &folder;
  const auto id = run_id(scene, options);
  std::string text;
  if (const auto earlier = finished_run(options.out, id)) {
    text = *earlier + "reused   everything: nothing has changed since the run above\n";
  } else {
    folder.check();
    check_scene(scene, arguments, options.with_dynamics ? RunExtent::whole : RunExtent::meshes);
    hold(arguments, options);
    remove_unfinished_files(options.out);
    remove_unfinished_files(options.cache);
    text = run_text(*run_system(scene, options));
    write_file(options.out / "run.log", log::recorded() + "\n" + text);
    folder.remove_earlier(is_of_run);
    keep_finished_run(options.out, id, text, folder.written(is_of_run));
  }
  if (arguments.json || arguments.quiet) {
    const auto summary = read_file(options.out / "summary.json");
    warn_of_results(summary);
    if (arguments.json) fmt::print("{}", summary);
  } else {
    if (!budget.empty()) text += budget + "\n";
    fmt::print("{}report  {}\n", text, (options.out / "report.html").string());
  }
}

void run_and_print(const Arguments& arguments, RunExtent extent) {
  std::string budget;
  const Scene scene = wanted_scene(arguments, budget);
  if (!budget.empty()) log::info(budget);
  auto options = run_options(arguments, scene);
  options.with_dynamics = extent == RunExtent::whole;
  run_and_print(arguments, scene, std::move(options), budget);
}

}  // namespace

namespace {

/// Prints what the results of this key mean; the same declaration of several kinds once. False: there is none.
bool explain_results(const std::string& key) {
  std::vector<std::pair<FigureSpec, std::vector<std::string>>> found;
  for (const auto& kind : system_kinds()) {
    const auto* spec = find_figure(kind.figures(), key);
    if (!spec) continue;
    const auto same = std::find_if(found.begin(), found.end(), [&](const auto& f) {
      return f.first.title == spec->title && f.first.definition == spec->definition;
    });
    if (same == found.end())
      found.push_back({*spec, {kind.scene.name}});
    else
      same->second.emplace_back(kind.scene.name);
  }
  for (const auto& [spec, kinds] : found) fmt::print("{}", explain(spec, kinds));
  return !found.empty();
}

}  // namespace

void run_command(const Arguments& arguments) { run_and_print(arguments, RunExtent::whole); }
void solve_command(const Arguments& arguments) { run_and_print(arguments, RunExtent::meshes); }

void dynamics_command(const Arguments& arguments) {
  const Scene scene = read_scene_with(arguments.scene, arguments.settings);
  if (!scene.dynamics) throw InputError(arguments.scene + ": has no [dynamics] table; add one to run the lumped model");
  run_and_print(arguments, RunExtent::whole);
}

void plan_command(const Arguments& arguments) {
  std::string budget;
  const Scene scene = wanted_scene(arguments, budget);
  check_stage(scene);
  check_files(scene);
  check_studies(scene);
  Plan plan = make_plan(scene, arguments.threads);
  plan.budget = budget;
  fmt::print("{}", arguments.json ? text_of(to_json(plan)) : arguments.inputs ? to_text(plan) : overview(plan));
  // The plan itself shows what is too much.
  std::fflush(stdout);
  check_limits(scene, limits_of(arguments), arguments.threads);
}

void geometry_command(const Arguments& arguments) {
  const Scene scene = read_scene_with(arguments.scene, arguments.settings);
  check_stage(scene);
  const auto data = make_system(scene)->drawing();
  if (data.gears.empty())
    throw InputError(fmt::format("{}: a stage of kind \"{}\" has no drawing data", arguments.scene, scene.stage.kind));
  fmt::print("{}", arguments.json ? text_of(drawing_json(data)) : drawing_text(data));
}

void check_command(const Arguments& arguments) {
  const Scene scene = read_scene_with(arguments.scene, arguments.settings);
  check_stage(scene);
  check_files(scene);
  check_studies(scene);
  const auto warnings = make_plan(scene, arguments.threads).warnings;
  if (arguments.json)
    fmt::print("{}", text_of({{"scene", arguments.scene}, {"warnings", to_json(warnings)}}));
  else {
    for (const auto& warning : warnings) fmt::print("{}\n", to_text(warning));
    fmt::print("{}: OK ({})\n", arguments.scene, make_system(scene)->describe());
  }
  if (arguments.strict && any_warning(warnings))
    throw InputError(arguments.scene + ": has warnings, which --strict refuses");
}

namespace {

/// What writes into OUT beside a run: `job` has the scene and its options, `which` are the names of its files.
void write_beside_runs(const Arguments& arguments, const ResultFolder::Which& which,
                       const std::function<void(const Scene&, const RunOptions&)>& job) {
  const Scene scene = read_scene_with(arguments.scene, arguments.settings);
  const auto options = run_options(arguments, scene);
  check_out(options.out);
  auto folder = folder_of(options, scene);
  folder.check();
  check_scene(scene, arguments, RunExtent::meshes);
  hold(arguments, options);
  remove_unfinished_files(options.out);
  remove_unfinished_files(options.cache);
  folder.begin();
  job(scene, options);
  folder.remove_earlier(which);
}

}  // namespace

void tradeoff_command(const Arguments& arguments) {
  write_beside_runs(arguments, is_of_tradeoff, [](const Scene& scene, const RunOptions& options) {
    const auto trade = measure_tradeoff(scene, options);
    write_tradeoff(trade, options.out);
    fmt::print("{}\ntable   {}\nreport  {}\n", trade_text(trade), (options.out / "tradeoff.csv").string(),
               (options.out / "tradeoff.html").string());
  });
}

void statics_command(const Arguments& arguments) {
  write_beside_runs(arguments, is_of_statics, [&](const Scene& scene, const RunOptions& options) {
    const auto statics = make_system(scene)->statics(with_reuse(options));
    for (const auto& warning : by_severity(statics.warnings))
      if (warning.severity != Severity::note)
        log::warn(warning.where.empty() ? warning.text : warning.where + ": " + warning.text);
    if (arguments.json)
      fmt::print("{}", text_of(statics.json));
    else if (!arguments.quiet)
      fmt::print("{}\nreport  {}\n", statics.text, (options.out / "statics.html").string());
  });
}

void study_plan_command(const Arguments& arguments) {
  const Scene scene = read_scene_with(arguments.scene, arguments.settings);
  const auto folder =
      arguments.out.empty() ? std::filesystem::path("study") / scene.file.stem() : std::filesystem::path(arguments.out);
  check_out(folder);
  check_scene(scene, arguments);
  check_studies(scene);
  fmt::print("{}", plan_study(scene, folder, arguments.shards));
}

void study_run_command(const Arguments& arguments) {
  const RunOptions options{.cache = arguments.folder, .threads = arguments.threads, .command = arguments.command_line};
  const auto worker = worker_of(arguments.shard);
  hold(arguments, options);
  fmt::print("{}", run_shard(arguments.folder, worker, options));
}

void study_collect_command(const Arguments& arguments) {
  const RunOptions options{.threads = arguments.threads, .command = "annulus study collect"};
  auto [scene, collecting] = collect_study(arguments.folder, options);
  run_and_print(arguments, scene, std::move(collecting), "");
}

void compare_command(const Arguments& arguments) {
  const std::filesystem::path page = arguments.out.empty() ? "comparison.html" : arguments.out;
  const auto table = std::filesystem::path(page).replace_extension(".csv");
  if (page.extension() != ".html")
    throw InputError(fmt::format("--out {}: is the name of the page; use the ending .html", page.string()));
  check_out(page.parent_path().empty() ? "." : page.parent_path());
  for (const auto& file : {page, table})
    if (std::filesystem::is_directory(file)) throw InputError(fmt::format("--out {}: is a folder", file.string()));
  if (std::filesystem::exists(table) && !is_comparison_table(table))
    throw InputError(
        fmt::format("--out {}: the table of the comparison would replace {}, which is none; give another name",
                    page.string(), table.string()));
  const auto runs = read_finished_runs(arguments.folders);
  if (page.has_parent_path()) std::filesystem::create_directories(page.parent_path());
  const auto pictures = page.stem().string() + "_pictures";
  ResultFolder folder(page.parent_path() / pictures, {page, "a comparison"});
  folder.begin();
  write_report(page, comparison_page(runs), pictures);
  folder.remove_earlier([](const std::string&) { return true; });
  write_file(table, comparison_csv(runs));
  if (arguments.json) {
    fmt::print("{}", text_of(comparison_json(runs)));
    return;
  }
  if (arguments.quiet) return;
  fmt::print("{}table   {}\npage    {}\npictures {}\n", comparison_text(runs), table.string(), page.string(),
             (page.parent_path() / pictures).string());
}

void explain_command(const Arguments& arguments) {
  if (arguments.json_schema) {
    fmt::print("{}", text_of(json_schema()));
    return;
  }
  if (arguments.markdown) {
    fmt::print("{}", scene_reference());
    return;
  }
  if (arguments.definitions) {
    fmt::print("{}", definitions_markdown());
    return;
  }
  bool found = false;
  for (const auto& table : schema()) {
    const bool whole_table = arguments.key == table.path && !table.path.empty();
    for (const auto& p : table.parameters) {
      if (!arguments.key.empty() && arguments.key != p.key() && arguments.key != p.name && !whole_table) continue;
      fmt::print("{}{}", found ? "\n" : "", explain(p));
      found = true;
    }
  }
  if (arguments.key.empty()) return;
  found = explain_results(arguments.key) || found;
  if (const auto* definition = find_definition(arguments.key)) {
    fmt::print("{}{}", found ? "\n" : "", explain(*definition));
    found = true;
  }
  if (found) return;
  if (const auto now = renamed_key(arguments.key); !now.empty()) throw InputError(arguments.key + ": is now " + now);
  auto names = all_keys();
  for (const auto& kind : system_kinds())
    for (auto& key : figure_keys(kind.figures())) names.push_back(std::move(key));
  for (const auto& definition : definitions()) names.push_back(definition.key);
  throw InputError(arguments.key + ": there is no such key, result or definition" + did_you_mean(arguments.key, names));
}

void export_command(const Arguments& arguments) {
  refuse_altered_result(arguments.scene);
  for (const auto& file :
       export_file(arguments.scene, arguments.format, arguments.out,
                   {.variant = arguments.ring, .threads = arguments.threads, .base_id = arguments.base_id}))
    fmt::print("written {}\n", file.string());
}

void cache_command(const Arguments& arguments) {
  if (arguments.cache.empty() && user_cache().empty())
    throw InputError(
        "each run has its own cache (ANNULUS_CACHE is empty, or the home folder is not known); give the cache of a "
        "run: OUT/cache");
  const auto folder = cache_of(arguments, {});
  if (arguments.clear) ResultStore::clear(folder);
  constexpr double MB = 1e-6;
  double bytes = 0;
  std::string text;
  for (const auto& kind : ResultStore::contents(folder)) {
    bytes += static_cast<double>(kind.bytes);
    text += fmt::format("  {:20} {:6} {:10.1f} MB\n", kind.kind, kind.results, MB * static_cast<double>(kind.bytes));
  }
  fmt::print("{}: {:.1f} MB of at most {:.0f} MB\n{}", folder.string(), MB * bytes,
             MB * static_cast<double>(ResultStore::usual_most_bytes), text);
}

void new_command(const Arguments& arguments) {
  if (!arguments.base.empty()) {
    if (!arguments.kind.empty() || !arguments.rexs.empty() || !arguments.example.empty() || arguments.minimal)
      throw InputError("--scene: that scene has its kind and its data; leave out the kind and the other options");
    fmt::print("{}", scene_text(read_scene_with(arguments.base, arguments.settings), {}));
    return;
  }
  if (!arguments.settings.empty()) throw InputError("--set: changes the values of a scene; name it with --scene");
  if (arguments.minimal) {
    if (!arguments.rexs.empty() || !arguments.example.empty() ||
        (!arguments.kind.empty() && arguments.kind != "planetary"))
      throw InputError("--minimal: writes a planetary stage; leave out the kind, --rexs and --example");
    fmt::print("{}", example_scene("minimal"));
    return;
  }
  if (!arguments.example.empty()) {
    if (!arguments.rexs.empty() || !arguments.kind.empty())
      throw InputError("--example: the example has its kind and its data; leave out the kind and --rexs");
    fmt::print("{}", example_to_start_from(arguments.example));
    return;
  }
  if (!arguments.rexs.empty()) {
    if (!arguments.kind.empty())
      throw InputError(arguments.kind + ": the kind of stage follows from the REXS file; give one of the two");
    const auto scene = read_rexs(arguments.rexs);
    fmt::print("{}", new_scene(scene.kind, scene.values));
    return;
  }
  const auto& kinds = stage_kinds();
  if (std::find(kinds.begin(), kinds.end(), arguments.kind) != kinds.end()) {
    fmt::print("{}", new_scene(arguments.kind, example_values(arguments.kind)));
    return;
  }
  const std::string near = nearest(arguments.kind, kinds);
  throw InputError(fmt::format("{}there is no such kind of stage{}; the kinds are {}",
                               arguments.kind.empty() ? "" : arguments.kind + ": ",
                               near.empty() ? "" : ", did you mean " + near + "?", listed(kinds)));
}

}  // namespace annulus::app
