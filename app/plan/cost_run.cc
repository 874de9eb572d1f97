#include "app/plan/cost_run.h"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <sstream>

#include "app/results/user_cache.h"
#include "core/errors.h"
#include "core/files.h"
#include "core/log.h"
#include "cost_runs_data.h"

namespace annulus::app {

namespace {

constexpr std::size_t longest_user_list = 200;
constexpr const char* cost_columns =
    "kind,degree,level,levels,unknowns,loads,phases,cycles,threads,error,body_s,contact_s,peak_MB,supports";
constexpr std::size_t cost_column_count = 14;

std::vector<std::string> cells_of(const std::string& line) {
  std::vector<std::string> cells;
  std::istringstream in(line);
  for (std::string cell; std::getline(in, cell, ',');) cells.push_back(cell);
  return cells;
}

double cost_number(const std::string& cell) {
  double value = 0;
  const auto [end, error] = std::from_chars(cell.data(), cell.data() + cell.size(), value);
  if (error != std::errc{} || end != cell.data() + cell.size() || !std::isfinite(value) || value < 0 || value > 1e12)
    throw InputError(fmt::format("'{}' is not a possible number", cell));
  return value;
}

int cost_count(const std::string& cell) {
  const double value = cost_number(cell);
  if (value != std::floor(value) || value > 1e6) throw InputError(fmt::format("'{}' is not a possible count", cell));
  return static_cast<int>(value);
}

CostRun cost_run(const std::vector<std::string>& cells) {
  if (cells.size() != cost_column_count || cells[0].empty())
    throw InputError(fmt::format("{} values where {} are expected", cells.size(), cost_column_count));
  CostRun run;
  run.kind = cells[0];
  run.degree = cost_count(cells[1]);
  run.level = cost_count(cells[2]);
  run.levels = cost_count(cells[3]);
  run.unknowns = cost_number(cells[4]);
  run.loads = cost_count(cells[5]);
  run.phases = cost_count(cells[6]);
  run.cycles = cost_count(cells[7]);
  run.threads = cost_count(cells[8]);
  run.error = cost_number(cells[9]);
  run.body_s = cost_number(cells[10]);
  run.contact_s = cost_number(cells[11]);
  run.peak_MB = cost_number(cells[12]);
  run.supports = cost_number(cells[13]);
  if (run.threads < 1 || run.levels < 1 || run.levels > 20 || (run.seconds() <= 0 && run.peak_MB <= 0))
    throw InputError("threads and levels, and time or memory, must be above zero");
  return run;
}

}  // namespace

std::vector<CostRun> parse_cost_runs(const std::string& text, const std::string& name) {
  std::vector<CostRun> runs;
  std::istringstream in(text);
  int number = 0;
  bool columns_seen = false;
  for (std::string line; std::getline(in, line);) {
    ++number;
    if (line.empty() || line.front() == '#') continue;
    try {
      if (!columns_seen) {
        if (line != cost_columns) throw InputError("not the columns of a list of measured costs");
        columns_seen = true;
      } else {
        runs.push_back(cost_run(cells_of(line)));
      }
    } catch (const InputError& error) {
      throw InputError(fmt::format("{}:{}: {}", name, number, error.what()));
    }
  }
  return runs;
}

std::string cost_runs_text(const std::vector<CostRun>& runs) {
  std::string text = std::string(cost_columns) + "\n";
  for (const auto& r : runs)
    text += fmt::format("{},{},{},{},{:.0f},{},{},{},{},{:.3g},{:.4g},{:.4g},{:.0f},{:.0f}\n", r.kind, r.degree,
                        r.level, r.levels, r.unknowns, r.loads, r.phases, r.cycles, r.threads, r.error, r.body_s,
                        r.contact_s, r.peak_MB, r.supports);
  return text;
}

const std::vector<CostRun>& kept_cost_runs() {
  static const std::vector<CostRun> runs = parse_cost_runs(cost_runs_data, "cost_runs.csv");
  return runs;
}

std::filesystem::path user_costs_file() {
  const auto folder = user_cache();
  return folder.empty() ? folder : folder / "costs.csv";
}

std::vector<CostRun> read_user_costs(const std::filesystem::path& file) {
  if (file.empty()) return {};
  try {
    if (!std::filesystem::exists(file)) return {};
    return parse_cost_runs(read_file(file), file.string());
  } catch (const std::exception& error) {
    log::debug(fmt::format("{}; the list is not used", error.what()));
    return {};
  }
}

void add_user_costs(const std::filesystem::path& file, const std::vector<CostRun>& runs) {
  if (file.empty() || runs.empty()) return;
  try {
    auto all = read_user_costs(file);
    all.insert(all.end(), runs.begin(), runs.end());
    if (all.size() > longest_user_list)
      all.erase(all.begin(), all.end() - static_cast<std::ptrdiff_t>(longest_user_list));
    std::filesystem::create_directories(file.parent_path());
    write_file(file, cost_runs_text(all));
  } catch (const std::exception& error) {
    log::debug(fmt::format("measured costs are not kept: {}", error.what()));
  }
}

}  // namespace annulus::app
