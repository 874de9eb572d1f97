#include "app/study/design_store.h"

#include "app/content_id.h"
#include "app/study/point_store.h"
#include "core/csv.h"
#include "core/files.h"

namespace annulus::app {

std::optional<Design> DesignStore::find(const std::vector<double>& x) const {
  auto point = read_point(point_file(), figures_, id_);
  if (!point || !std::filesystem::exists(starts_file())) return std::nullopt;
  Design design{.x = x, .objective = 0, .point = std::move(*point), .starts = std::nullopt};
  try {
    const Csv csv = Csv::read(starts_file());
    if (csv.header.size() < 5 || csv.header[1].second != id_) return std::nullopt;
    StartSpread spread{.starts = std::stoi(csv.header[2].second),
                       .motions = std::stoi(csv.header[3].second),
                       .not_steady = std::stoi(csv.header[4].second)};
    if (!csv.rows.empty()) {
      spread.low = spread.high = FigureRow(figures_);
      for (std::size_t i = 0; i < csv.columns.size(); ++i) {
        spread.low.set(csv.columns[i], csv.rows.at(0)[i]);
        spread.high.set(csv.columns[i], csv.rows.at(1)[i]);
      }
    }
    if (spread.starts > 0) design.starts = std::move(spread);
  } catch (const std::exception&) {
    return std::nullopt;  // damaged: found again and overwritten
  }
  return design;
}

void DesignStore::save(const Design& design) const {
  std::filesystem::create_directories(folder_);
  write_file(point_file(), point_text(design.point, figures_, id_));
  const auto spread = design.starts.value_or(StartSpread{});
  Csv csv{.header = {{"annulus_version", version()},
                     {"inputs_id", id_},
                     {"starts", std::to_string(spread.starts)},
                     {"motions", std::to_string(spread.motions)},
                     {"not_steady", std::to_string(spread.not_steady)}},
          .columns = {},
          .rows = {}};
  // A column per result; the lowest values, then the highest ones.
  for (const auto& figure : figures_) csv.columns.push_back(figure.key);
  for (const auto* row : {&spread.low, &spread.high}) {
    if (row->empty()) continue;
    auto& cells = csv.rows.emplace_back();
    for (const auto& figure : figures_) cells.push_back(row->value(figure.key));
  }
  csv.write(starts_file());
}

}  // namespace annulus::app
