#include "app/cli.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cctype>
#include <cstdio>
#include <filesystem>
#include <functional>
#include <iostream>
#include <map>
#include <new>
#include <system_error>
#include <thread>

#include "app/commands.h"
#include "app/completion.h"
#include "app/export/export.h"
#include "app/process/held_limits.h"
#include "app/process/interruption.h"
#include "app/process/progress.h"
#include "app/process/system_limits.h"
#include "app/results/content_id.h"
#include "app/scene/example_scenes.h"
#include "app/scene/scene_schema.h"
#include "app/scene/scene_value.h"
#include "core/errors.h"
#include "core/files.h"
#include "core/log.h"

namespace annulus::app {

namespace {

enum ExitStatus { done = 0, defect = 1, wrong_input = 2, refused = 3, limit_reached = 4, interrupted = 130 };

void add_common(CLI::App& command, Arguments& arguments) {
  command.add_option("--threads", arguments.threads, "Threads to use")
      ->check(CLI::Range(1, 4096))
      ->capture_default_str();
  auto* quiet = command.add_flag("--quiet,-q", arguments.quiet, "Warnings and errors only");
  command.add_flag("--verbose,-v", arguments.verbose, "More messages")->excludes(quiet);
}

/// One line each, for the end of a help text.
std::string example_names() {
  std::string text;
  for (const auto& example : example_scenes()) text += "  " + example.name + "\n";
  return text;
}

CLI::App* add_command(CLI::App& app, Arguments& arguments, const char* name, const char* what) {
  auto* command = app.add_subcommand(name, what);
  command->add_option("scene", arguments.scene, "Scene file (TOML)")->required();
  command
      ->add_option("--set", arguments.settings,
                   "Other value for a key of the scene, KEY=VALUE: accuracy=0.03, ring.pins=12; can be repeated")
      ->allow_extra_args(false);
  add_common(*command, arguments);
  return command;
}

/// The message about a first word that is not a command; empty when the arguments are wrong in another way.
std::string unknown_command(const CLI::App& app) {
  const auto named = app.get_subcommands();
  const CLI::App& of = named.empty() ? app : *named.front();
  const auto words = of.remaining();
  if (of.get_subcommands({}).empty() || !of.get_subcommands().empty() || words.empty() ||
      words.front().starts_with('-'))
    return "";
  const std::string& word = words.front();
  std::vector<std::string> commands;
  std::string known;
  for (const auto* command : of.get_subcommands({})) {
    commands.push_back(command->get_name());
    known += (known.empty() ? "" : ", ") + commands.back();
  }
  const std::string near = nearest(word, commands);
  return fmt::format("{}: there is no such command{}; the commands are {} (annulus --help lists more)", word,
                     near.empty() ? "" : ", did you mean " + near + "?", known);
}

/// "run", or "study run" of a part of a command.
std::string name_of(const CLI::App& command, const CLI::App& app) {
  const auto* parent = command.get_parent();
  return parent == &app ? command.get_name() : parent->get_name() + " " + command.get_name();
}

/// The message about an option that the command, or annulus without one, does not have; empty when all are known.
std::string unknown_option(const CLI::App& app, int argc, char** argv) {
  const CLI::App* command = &app;
  for (int i = 1; i < argc; ++i) {
    const std::string word = argv[i];
    if (word == "--") break;
    for (const auto* named : command->get_subcommands({}))
      if (named->get_name() == word) command = named;
    if (word.size() < 2 || word.front() != '-' || std::isdigit(static_cast<unsigned char>(word[1])) != 0) continue;
    const auto name = word.substr(0, word.find('='));
    const bool one_letter = name[1] != '-';
    if (command->get_option_no_throw(one_letter ? name.substr(0, 2) : name)) continue;
    std::vector<std::string> known;
    for (const auto* option : command->get_options())
      for (const auto& other : option->get_lnames()) known.push_back("--" + other);
    const auto near = nearest(name, known);
    return fmt::format("{}: {} has no such option{}; the options are {}", name,
                       command == &app ? "annulus" : "annulus " + name_of(*command, app),
                       near.empty() ? "" : ", did you mean " + near + "?", fmt::join(known, ", "));
  }
  return "";
}

/// All commands with their options, which write into `arguments`.
void declare(CLI::App& app, Arguments& arguments) {
  app.set_version_flag("--version", std::string("annulus ") + version());
  app.require_subcommand(1);
  app.set_help_all_flag("--help-all", "Help of all commands");
  add_common(app, arguments);
  app.footer(
      "Examples:\n"
      "  annulus new planetary > my.toml     a scene to start from, every key with its meaning\n"
      "  annulus plan my.toml                the model and the predicted time\n"
      "  annulus run my.toml                 everything, with the report out/my/report.html\n"
      "'annulus COMMAND --help' describes a command.");

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
                        "Refuse a run that is predicted to need more, and end a run that needs more: 16GB, 800MB; "
                        "default: the memory of the machine, for the prediction only");
    command->add_option("--max-time", arguments.max_time,
                        "Refuse a run that is predicted to take longer, and end a run that takes longer: 2h, 3d; "
                        "default: a week, for the prediction only");
    return command;
  };
  const auto cache = [&](CLI::App* command) {
    command->add_option("--cache", arguments.cache,
                        "Folder of cached results; default $ANNULUS_CACHE/results or ~/.cache/annulus/results");
    return command;
  };
  const auto examples = [](CLI::App* command, const std::string& text) { command->footer("Examples:\n" + text); };

  const auto json = [&](CLI::App* command) {
    command->add_flag("--json", arguments.json, "Print the results as JSON instead of a table");
    return command;
  };
  examples(json(cache(
               limits(budget(out(add_command(app, arguments, "run", "Runs the whole scene and writes the report")))))),
           "  annulus run my.toml\n"
           "  annulus run my.toml -o results --threads 4\n"
           "  annulus run my.toml --budget 30s      as accurate as half a minute allows\n"
           "  annulus run my.toml --set supports.sun_N_per_m=floating -o out/floating");
  examples(json(cache(limits(
               out(add_command(app, arguments, "solve", "Meshes, loaded transmission error, stiffness tables"))))),
           "  annulus solve my.toml -o results");
  examples(
      json(cache(limits(out(add_command(
          app, arguments, "dynamics", "The lumped model from stiffness tables; missing tables are computed first"))))),
      "  annulus dynamics faster.toml          uses cached tables of earlier runs");
  examples(json(cache(limits(out(add_command(
               app, arguments, "statics", "Equilibrium of a planetary stage over a turn of the carrier, in space"))))),
           "  annulus statics my.toml               then open out/my/statics.html\n"
           "  annulus statics my.toml --set statics.carrier_positions=64");
  examples(cache(limits(out(add_command(app, arguments, "tradeoff",
                                        "Measures all ways to compute the stage: error against time and memory")))),
           "  annulus tradeoff my.toml              then open out/my/tradeoff.html");
  auto* study = app.add_subcommand("study", "The studies of a scene on many cores or machines: plan, run, collect");
  study->require_subcommand(1);
  auto* divide =
      out(add_command(*study, arguments, "plan",
                      "Writes the parts of the studies with predicted times, and scripts that start workers"));
  divide->add_option("--shards", arguments.shards, "Workers that share the parts")
      ->check(CLI::Range(1, 100'000))
      ->capture_default_str();
  const auto of_study = [&](const char* name, const char* what) {
    auto* command = study->add_subcommand(name, what);
    command->add_option("folder", arguments.folder, "Folder that annulus study plan wrote")->required();
    add_common(*command, arguments);
    return command;
  };
  auto* work = limits(of_study("run", "Computes the parts of one worker that nobody has computed yet"));
  work->add_option("--shard", arguments.shard, "Which worker of how many: 3/7")->required();
  auto* merge = json(limits(of_study("collect", "Merges what the workers found; report and tables in FOLDER/results")));
  examples(divide,
           "  annulus study plan my.toml -o my_study --shards 100\n"
           "  my_study/study.sh                     all workers on this machine\n"
           "  sbatch my_study/study.sbatch          all workers on a cluster");
  examples(work, "  annulus study run my_study --shard 3/100");
  examples(merge, "  annulus study collect my_study        then open my_study/results/report.html");
  auto* compare =
      app.add_subcommand("compare", "Finished runs side by side: results, errors, inputs that differ, cost");
  compare->add_option("folders", arguments.folders, "Folders that annulus run wrote, two or more");
  compare->add_option("-o,--out", arguments.out,
                      "Page to write, FILE.html, with FILE.csv beside it; default comparison.html");
  compare->add_flag("--json", arguments.json, "The comparison as JSON");
  add_common(*compare, arguments);
  examples(compare,
           "  annulus compare out/my out/faster\n"
           "  annulus compare out/held out/pins24 out/pins12 -o pins.html");
  auto* plan = limits(budget(
      add_command(app, arguments, "plan", "The model with reasons, predicted time and memory; computes nothing")));
  plan->add_flag("--inputs", arguments.inputs, "Also every input with its origin, all reasons and remarks");
  plan->add_flag("--json", arguments.json, "As JSON");
  examples(plan,
           "  annulus plan my.toml\n"
           "  annulus plan my.toml --json | jq .cost");
  auto* check = add_command(app, arguments, "check", "Check the scene only, and print its warnings");
  check->add_flag("--strict", arguments.strict, "Fail on warnings; notes do not count as warnings");
  check->add_flag("--json", arguments.json, "Warnings as JSON");
  examples(check, "  annulus check my.toml\n  annulus check my.toml --strict");
  auto* geometry =
      add_command(app, arguments, "geometry", "Drawing data of the gears: diameters, spans, pins, contact");
  geometry->add_flag("--json", arguments.json, "As JSON");
  examples(geometry,
           "  annulus geometry my.toml\n"
           "  annulus geometry my.toml --json | jq .gears.sun.span_mm");

  auto* send = app.add_subcommand("export", "Results and gear data in the formats of other programs");
  send->add_option("file", arguments.scene, "A table of a run (CSV), or a scene")->required();
  std::string formats;
  for (const auto& f : export_formats()) formats += (formats.empty() ? "" : "|") + std::string(f.name);
  send->add_option("--to", arguments.format, "Format: " + formats)->required();
  send->add_option("-o,--out", arguments.out, "File to write; default beside the source, with the format's ending");
  send->add_option("--ring", arguments.ring, "Ring of the scene, if it has several");
  send->add_option("--base-id", arguments.base_id, "Number of the first statement (adams); default 1")
      ->check(CLI::PositiveNumber);
  add_common(*send, arguments);
  std::string what;
  for (const auto& f : export_formats()) what += fmt::format("  {:9} {:11} {}\n", f.name, f.ending, f.what);
  examples(send,
           "  annulus export out/my/ring/stiffness_ring_planet.csv --to matlab\n"
           "  annulus export out/my/ring/ring_compliance.csv --to hdf5 -o ring.h5\n"
           "  annulus export my.toml --to rexs\n"
           "  annulus export my.toml --to matlab      M, C, G, K, B of its lumped system\nFormats:\n" +
               what);

  auto* fresh = app.add_subcommand("new", "Writes a commented scene to standard output");
  fresh->add_option("kind", arguments.kind, "Kind of stage: " + listed(stage_kinds()));
  fresh->add_option("--rexs", arguments.rexs, "Fill it with the gear data of this REXS file");
  fresh->add_option("--example", arguments.example, "The scene of this name from the project's examples and cases");
  fresh->add_flag("--minimal", arguments.minimal, "A planetary stage with as few lines as possible");
  fresh->add_option("--scene", arguments.base, "This scene without its comments, with the values of --set");
  fresh->add_option("--set", arguments.settings, "Other value for a key of --scene, KEY=VALUE; can be repeated")
      ->allow_extra_args(false);
  add_common(*fresh, arguments);
  examples(fresh,
           "  annulus new planetary > my.toml\n"
           "  annulus new --minimal > my.toml       25 lines\n"
           "  annulus new --rexs gearbox.rexs > my.toml\n"
           "  annulus new --scene my.toml --set ring.pins=12 > other.toml\n"
           "  annulus new --example grc_750kw/planetary_stage > my.toml\nScenes for --example:\n" +
               example_names());

  auto* explain_key = app.add_subcommand("explain", "Explains keys of a scene file, results and terms");
  explain_key->add_option("key", arguments.key,
                          "Key or table of a scene, key of a result, or a term such as K_V; absent: all keys");
  auto* markdown = explain_key->add_flag("--markdown", arguments.markdown, "The scene reference as Markdown");
  explain_key->add_flag("--definitions", arguments.definitions, "All definitions as Markdown")->excludes(markdown);
  explain_key->add_flag("--json-schema", arguments.json_schema, "The keys of scenes as a JSON Schema, for editors")
      ->excludes(markdown);
  add_common(*explain_key, arguments);
  examples(explain_key,
           "  annulus explain module_mm\n"
           "  annulus explain supports\n"
           "  annulus explain K_V");

  auto* cached = app.add_subcommand("cache", "Lists or removes cached results");
  cached->add_option("folder", arguments.cache, "Folder of the cache; default: the cache that runs use");
  cached->add_flag("--clear", arguments.clear, "Remove all cached results");
  add_common(*cached, arguments);
  examples(cached,
           "  annulus cache\n"
           "  annulus cache --clear");

  auto* completion = app.add_subcommand("completion", "Completion of commands and options for a shell");
  completion->add_option("shell", arguments.shell, "bash, zsh or fish")->required();
  examples(completion, "  annulus completion bash > ~/.local/share/bash-completion/completions/annulus");
}

constexpr const char* no_output = "cannot write to the standard output: check that it is open and its disk is not full";

/// The link on the way to this path that leads nowhere; empty when there is none.
std::filesystem::path dangling_link(const std::filesystem::path& path) {
  namespace fs = std::filesystem;
  std::error_code error;
  fs::path at;
  for (const auto& part : path) {
    at /= part;
    if (fs::is_symlink(fs::symlink_status(at, error)) && !fs::exists(at, error)) return at;
  }
  return {};
}

/// A folder that cannot be made or read.
std::string folder_message(const std::filesystem::filesystem_error& error) {
  const auto link = dangling_link(error.path1());
  if (!link.empty())
    return fmt::format("{}: is a link to {}, which does not exist; make that folder or remove the link", link.string(),
                       std::filesystem::read_symlink(link).string());
  return fmt::format("{}: {}; check that its folder exists, is writable and not full", error.path1().string(),
                     error.code().message());
}

/// A thread that could not be started, for example.
std::string system_message(const std::system_error& error) {
  return fmt::format("refused by the system: {}; raise its limits (ulimit -a) or use fewer --threads", error.what());
}

/// Refuses what the limits of the system do not let end.
void check_system_limits(const std::string& command, const Arguments& arguments) {
  for (const char* computes : {"run", "solve", "dynamics", "statics", "tradeoff", "study run", "study collect"})
    if (command == computes) {
      ensure_stack();
      return reserve_blas_memory(arguments.threads);
    }
  if (command == "plan" || command == "check" || command == "geometry" || command == "study plan")
    reserve_blas_memory(1);
}

int parse_and_run(int argc, char** argv) {
  Arguments arguments;
  arguments.threads = static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
  CLI::App app("Effect of the ring gear structure on load sharing and vibration of planetary gear sets.", "annulus");
  declare(app, arguments);
  const auto fail = [](const std::string& message, ExitStatus status) {
    log::error(message);
    return status;
  };
  try {
    watch_for_interruption(interrupted, limit_reached);
  } catch (const std::system_error& error) {
    return fail(system_message(error), refused);
  }
  try {
    for (int i = 0; i < argc; ++i)
      arguments.command_line += (i > 0 ? " " : "") + (i > 0 ? std::string(argv[i]) : std::string("annulus"));
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    if (const std::string unknown = unknown_command(app); !unknown.empty()) {
      log::error(unknown);
      return wrong_input;
    }
    const bool asks_for_help = error.get_exit_code() == 0;
    if (const std::string unknown = asks_for_help ? std::string() : unknown_option(app, argc, argv); !unknown.empty()) {
      log::error(unknown);
      return wrong_input;
    }
    const int status = app.exit(error);
    if (!std::cout.flush()) return fail(no_output, wrong_input);
    return status == 0 ? done : wrong_input;
  }
  log::set_level(arguments.quiet ? log::Level::quiet : arguments.verbose ? log::Level::verbose : log::Level::normal);
  show_progress(!arguments.quiet);

  const std::map<std::string, std::function<void()>> commands = {
      {"run", [&] { run_command(arguments); }},
      {"solve", [&] { solve_command(arguments); }},
      {"dynamics", [&] { dynamics_command(arguments); }},
      {"statics", [&] { statics_command(arguments); }},
      {"tradeoff", [&] { tradeoff_command(arguments); }},
      {"study plan", [&] { study_plan_command(arguments); }},
      {"study run", [&] { study_run_command(arguments); }},
      {"study collect", [&] { study_collect_command(arguments); }},
      {"compare", [&] { compare_command(arguments); }},
      {"plan", [&] { plan_command(arguments); }},
      {"check", [&] { check_command(arguments); }},
      {"geometry", [&] { geometry_command(arguments); }},
      {"export", [&] { export_command(arguments); }},
      {"cache", [&] { cache_command(arguments); }},
      {"new", [&] { new_command(arguments); }},
      {"explain", [&] { explain_command(arguments); }},
      {"completion", [&] { fmt::print("{}", completion_script(app, arguments.shell)); }}};
  try {
    const auto* named = app.get_subcommands().front();
    if (const auto parts = named->get_subcommands(); !parts.empty()) named = parts.front();
    const auto command = name_of(*named, app);
    check_system_limits(command, arguments);
    commands.at(command)();
    // What stands in the buffer is written only now.
    return std::fflush(stdout) == 0 && std::ferror(stdout) == 0 ? done : fail(no_output, wrong_input);
  } catch (const InputError& error) {
    return fail(error.what(), wrong_input);
  } catch (const FileError& error) {
    return fail(error.what(), wrong_input);
  } catch (const LimitError& error) {
    return fail(error.what(), limit_reached);
  } catch (const Error& error) {
    return fail(error.what(), refused);
  } catch (const std::filesystem::filesystem_error& error) {
    return fail(folder_message(error), wrong_input);
  } catch (const std::system_error& error) {
    if (std::ferror(stdout) != 0) return fail(no_output, wrong_input);
    return fail(system_message(error), refused);
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::exception& error) {
    return fail(std::string("defect in annulus, please report it: ") + error.what(), defect);
  }
}

}  // namespace

int run_command_line(int argc, char** argv) {
  try {
    return parse_and_run(argc, argv);
  } catch (const std::bad_alloc&) {
    log::error(
        "out of memory: ask for less accuracy or fewer threads; finished results are stored and reused by the next "
        "run");
    return refused;
  }
}

}  // namespace annulus::app
