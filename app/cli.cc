#include "app/cli.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <new>
#include <optional>
#include <thread>

#include "app/content_id.h"
#include "app/finished_run.h"
#include "app/interruption.h"
#include "app/pipeline.h"
#include "app/plan/cost_budget.h"
#include "app/plan/run_limits.h"
#include "app/progress.h"
#include "app/scene/scene_files.h"
#include "app/scene/scene_schema.h"
#include "app/stage_kinds.h"
#include "app/study/studies.h"
#include "app/tradeoff/trade_report.h"
#include "core/errors.h"
#include "core/files.h"
#include "core/log.h"

namespace annulus::app {

namespace {

enum ExitStatus { done = 0, defect = 1, wrong_input = 2, refused = 3, interrupted = 130 };

struct Arguments {
  std::string scene, out, tables, key;
  std::optional<std::string> budget, max_memory, max_time;
  bool json = false, markdown = false, quiet = false, verbose = false;
  int threads = static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
};

RunOptions run_options(const Arguments& arguments, const Scene& scene) {
  RunOptions options{.threads = arguments.threads};
  options.out =
      arguments.out.empty() ? std::filesystem::path("out") / scene.file.stem() : std::filesystem::path(arguments.out);
  if (!arguments.tables.empty()) options.tables = arguments.tables;
  return options;
}

RunLimits limits_of(const Arguments& arguments) {
  auto limits = RunLimits::of_this_machine();
  if (arguments.max_memory) limits.memory_MB = parse_memory(*arguments.max_memory);
  if (arguments.max_time) limits.seconds = parse_duration(*arguments.max_time, "--max-time");
  return limits;
}

/// Whether results can be written there, told before anything is computed; makes nothing.
void check_out(const std::filesystem::path& out) {
  namespace fs = std::filesystem;
  fs::path there = fs::absolute(out).lexically_normal();
  std::error_code error;
  while (!fs::exists(there, error) && there.has_relative_path()) there = there.parent_path();
  if (!fs::is_directory(there, error))
    throw InputError(fmt::format("--out {}: {} is not a folder", out.string(), there.string()));
  if (::access(there.c_str(), W_OK | X_OK) != 0)
    throw InputError(fmt::format("--out {}: cannot write in {}", out.string(), there.string()));
}

/// What can be known to be wrong before anything is computed; the run itself checks its studies first.
void check_scene(const Scene& scene, const Arguments& arguments, bool with_dynamics = true) {
  check_stage(scene);
  check_files(scene);
  check_limits(scene, limits_of(arguments), arguments.threads, CostModel::of_this_machine(), with_dynamics);
}

/// The scene as the file has it, or as accurate as the budget allows; what that means goes into `sentence`.
Scene wanted_scene(const Arguments& arguments, std::string& sentence) {
  const double budget = arguments.budget ? parse_duration(*arguments.budget) : 0;
  Scene scene = read_scene(arguments.scene);
  if (!arguments.budget) return scene;
  check_stage(scene);
  auto choice = fit_budget(scene, budget, arguments.threads, CostModel::of_this_machine());
  sentence = std::move(choice.sentence);
  return std::move(choice.scene);
}

void run_and_print(const Arguments& arguments, bool with_dynamics) {
  std::string budget;
  const Scene scene = wanted_scene(arguments, budget);
  if (!budget.empty()) log::info(budget);
  auto options = run_options(arguments, scene);
  options.with_dynamics = with_dynamics;
  check_out(options.out);
  const auto id = run_id(scene, options);
  if (const auto earlier = finished_run(options.out, id)) {
    fmt::print("{}reused   everything: nothing has changed since the run above\n", *earlier);
  } else {
    check_scene(scene, arguments, with_dynamics);
    remove_unfinished_files(options.out);
    const auto text = run_scene(scene, options);
    fmt::print("{}", text);
    keep_finished_run(options.out, id, text);
  }
  if (!budget.empty()) fmt::print("{}\n", budget);
  fmt::print("report  {}\n", (options.out / "report.html").string());
}

void dynamics_command(const Arguments& arguments) {
  const Scene scene = read_scene(arguments.scene);
  if (!scene.dynamics) throw InputError(arguments.scene + ": has no [dynamics] table; add one to run the lumped model");
  run_and_print(arguments, true);
}

void plan_command(const Arguments& arguments) {
  std::string budget;
  const Scene scene = wanted_scene(arguments, budget);
  check_stage(scene);
  check_files(scene);
  check_studies(scene);
  fmt::print("{}", plan_scene(scene, arguments.json, arguments.threads, budget));
  // The plan itself shows what is too much.
  std::fflush(stdout);
  check_limits(scene, limits_of(arguments), arguments.threads, CostModel::of_this_machine());
}

void check_command(const Arguments& arguments) {
  const Scene scene = read_scene(arguments.scene);
  check_stage(scene);
  check_files(scene);
  check_studies(scene);
  fmt::print("{}: good ({})\n", arguments.scene, stage_text(scene));
}

void tradeoff_command(const Arguments& arguments) {
  const Scene scene = read_scene(arguments.scene);
  const auto options = run_options(arguments, scene);
  check_out(options.out);
  check_scene(scene, arguments, false);
  remove_unfinished_files(options.out);
  const auto trade = measure_tradeoff(scene, options);
  write_tradeoff(trade, options.out);
  fmt::print("{}\ntable   {}\nreport  {}\n", trade_text(trade), (options.out / "tradeoff.csv").string(),
             (options.out / "tradeoff.html").string());
}

void explain_command(const Arguments& arguments) {
  if (arguments.markdown) {
    fmt::print("{}", scene_reference());
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
  if (found) return;
  const std::string near = nearest(arguments.key, all_keys());
  throw InputError(arguments.key + ": there is no such key" + (near.empty() ? "" : "; did you mean " + near + "?"));
}

void add_common(CLI::App& command, Arguments& arguments) {
  command.add_option("--threads", arguments.threads, "Threads to use")
      ->check(CLI::Range(1, 4096))
      ->capture_default_str();
  auto* quiet = command.add_flag("--quiet,-q", arguments.quiet, "Warnings and errors only");
  command.add_flag("--verbose,-v", arguments.verbose, "More messages")->excludes(quiet);
}

CLI::App* add_command(CLI::App& app, Arguments& arguments, const char* name, const char* what) {
  auto* command = app.add_subcommand(name, what);
  command->add_option("scene", arguments.scene, "Scene file (TOML)")->required();
  add_common(*command, arguments);
  return command;
}

/// The message about a first word that is not a command; empty when the arguments are wrong in another way.
std::string unknown_command(const CLI::App& app) {
  const auto words = app.remaining();
  if (!app.get_subcommands().empty() || words.empty() || words.front().starts_with('-')) return "";
  const std::string& word = words.front();
  std::vector<std::string> commands;
  std::string known;
  for (const auto* command : app.get_subcommands({})) {
    commands.push_back(command->get_name());
    known += (known.empty() ? "" : ", ") + commands.back();
  }
  const std::string near = nearest(word, commands);
  return fmt::format("{}: there is no such command{}; the commands are {} (annulus --help tells more)", word,
                     near.empty() ? "" : ", did you mean " + near + "?", known);
}

}  // namespace

int run_command_line(int argc, char** argv) {
  watch_for_interruption(interrupted);

  Arguments arguments;
  CLI::App app("What the structure of a ring gear does to load sharing and vibration of a planetary gear set.",
               "annulus");
  app.set_version_flag("--version", std::string("annulus ") + version());
  app.require_subcommand(1);
  add_common(app, arguments);

  const auto out = [&](CLI::App* command) {
    command->add_option("-o,--out", arguments.out, "Folder of the results; default out/<scene name>");
    return command;
  };
  const auto budget = [&](CLI::App* command) {
    command->add_option("--budget", arguments.budget,
                        "The most accurate plan predicted to fit this time: 30s, 2min, 500ms, 1h");
    return command;
  };
  const auto limits = [&](CLI::App* command) {
    command->add_option("--max-memory", arguments.max_memory,
                        "Refuse what is predicted to need more: 16GB, 800MB; default the memory of the machine");
    command->add_option("--max-time", arguments.max_time,
                        "Refuse what is predicted to take longer: 2h, 3d; default a week");
    return command;
  };
  limits(budget(out(add_command(app, arguments, "run", "Everything the scene asks for, and the report"))));
  limits(out(add_command(app, arguments, "solve", "Meshes, loaded transmission error, stiffness tables")));
  auto* dynamics =
      limits(out(add_command(app, arguments, "dynamics", "The lumped model from tables, solved first if missing")));
  dynamics->add_option("--tables", arguments.tables,
                       "Folder of an earlier run whose tables are used if they still fit");
  limits(out(add_command(app, arguments, "tradeoff",
                         "Every way to compute the stage measured: error against time and memory")));
  auto* plan = limits(budget(add_command(
      app, arguments, "plan", "What will be modelled and why, predicted time and memory; computes nothing")));
  plan->add_flag("--json", arguments.json, "As JSON");
  add_command(app, arguments, "check", "Check the scene only");
  auto* explain_key = app.add_subcommand("explain", "The keys of a scene file");
  explain_key->add_option("key", arguments.key, "Key, key path or table; absent: all");
  explain_key->add_flag("--markdown", arguments.markdown, "The scene reference as Markdown");
  add_common(*explain_key, arguments);

  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    if (const std::string unknown = unknown_command(app); !unknown.empty()) {
      fmt::print(stderr, "{}\n", unknown);
      return wrong_input;
    }
    const int status = app.exit(error);
    return status == 0 ? done : wrong_input;
  }
  log::set_level(arguments.quiet ? log::Level::quiet : arguments.verbose ? log::Level::verbose : log::Level::normal);
  show_progress(!arguments.quiet);

  const auto fail = [](const std::exception& error, ExitStatus status) {
    fmt::print(stderr, "{}\n", error.what());
    return status;
  };
  try {
    const std::string command = app.get_subcommands().front()->get_name();
    if (command == "run") run_and_print(arguments, true);
    if (command == "solve") run_and_print(arguments, false);
    if (command == "dynamics") dynamics_command(arguments);
    if (command == "tradeoff") tradeoff_command(arguments);
    if (command == "plan") plan_command(arguments);
    if (command == "check") check_command(arguments);
    if (command == "explain") explain_command(arguments);
    return done;
  } catch (const InputError& error) {
    return fail(error, wrong_input);
  } catch (const Error& error) {
    return fail(error, refused);
  } catch (const std::filesystem::filesystem_error& error) {
    return fail(error, wrong_input);
  } catch (const std::bad_alloc&) {
    fmt::print(stderr,
               "out of memory: ask for less accuracy or fewer threads; finished results are kept and reused by the "
               "next run\n");
    return refused;
  } catch (const std::exception& error) {
    fmt::print(stderr, "defect in annulus, please report it: ");
    return fail(error, defect);
  }
}

}  // namespace annulus::app
