#pragma once

#include <optional>
#include <string>
#include <vector>

namespace annulus::app {

/// What the command line says, whatever the command.
struct Arguments {
  std::string scene, out, cache, key, format, ring, kind, rexs, example, base, shell, folder, shard;
  std::string command_line;          ///< as a whole
  std::vector<std::string> folders;  ///< of compare
  std::optional<std::string> budget, max_memory, max_time;
  std::vector<std::string> settings;  ///< of --set
  bool inputs = false, minimal = false, json = false, strict = false, markdown = false, definitions = false,
       json_schema = false, clear = false, quiet = false, verbose = false;
  int threads = 1, shards = 8;
  std::optional<int> base_id;  ///< of numbered statements
};

/// The commands, each from checking its arguments to its last line of output. They throw what the stages throw.
void run_command(const Arguments& arguments);
void solve_command(const Arguments& arguments);
void dynamics_command(const Arguments& arguments);
void statics_command(const Arguments& arguments);
void tradeoff_command(const Arguments& arguments);
void plan_command(const Arguments& arguments);
void study_plan_command(const Arguments& arguments);
void study_run_command(const Arguments& arguments);
void study_collect_command(const Arguments& arguments);
void compare_command(const Arguments& arguments);
void check_command(const Arguments& arguments);
void geometry_command(const Arguments& arguments);
void export_command(const Arguments& arguments);
void cache_command(const Arguments& arguments);
void new_command(const Arguments& arguments);
void explain_command(const Arguments& arguments);

}  // namespace annulus::app
