#pragma once

#include <filesystem>
#include <map>
#include <sstream>
#include <string>
#include <vector>

#include "core/figure.h"
#include "core/files.h"

namespace annulus::test {

/// The results of the only ring, or of a kind without rings, in the figures.csv of a finished run, by their keys.
inline std::map<std::string, Figure> stated_results(const std::filesystem::path& out) {
  std::map<std::string, Figure> results;
  std::istringstream lines(read_file(out / "figures.csv"));
  for (std::string line; std::getline(lines, line);) {
    std::vector<std::string> cells;
    std::istringstream cut(line);
    for (std::string cell; cells.size() < 5 && std::getline(cut, cell, ',');) cells.push_back(cell);
    if (cells.size() < 5 || cells[1] == "key" || cells[3].empty()) continue;
    results[cells[1]] = {std::stod(cells[3]), cells[4].empty() ? not_known : std::stod(cells[4])};
  }
  return results;
}

}  // namespace annulus::test
