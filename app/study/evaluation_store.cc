#include "app/study/evaluation_store.h"

#include <algorithm>

#include "app/results/content_id.h"
#include "core/result_store.h"

namespace annulus::app {

namespace {
const std::string failure_line = "failure_";
constexpr const char* searches = "searches";
constexpr auto evaluations_interval = std::chrono::seconds(2);  // the most that an interruption costs
}  // namespace

EvaluationStore::EvaluationStore(const ResultStore* store, std::string id, std::vector<std::string> variables,
                                 std::vector<std::string> figures, const std::vector<FigureSpec>& specs)
    : store_(store),
      id_(std::move(id)),
      variables_(std::move(variables)),
      figures_(std::move(figures)),
      specs_(specs),
      saved_(std::chrono::steady_clock::now()) {
  read();
}

void EvaluationStore::read() {
  const auto cached = store_ ? store_->find(searches, id_) : std::nullopt;
  if (!cached) return;
  const Csv csv = Csv::parse(*cached, searches);
  std::map<std::string, std::string> failures(csv.header.begin(), csv.header.end());
  const auto n = static_cast<std::ptrdiff_t>(variables_.size());
  for (std::size_t row = 0; row < csv.rows.size(); ++row) {
    const auto& values = csv.rows[row];
    const std::vector<double> x(values.begin(), values.begin() + n);
    StudyPoint point;
    if (values[variables_.size()] == 0) {
      point.figures = FigureRow(specs_);
      for (std::size_t i = 0; i < figures_.size(); ++i)
        point.figures.set(figures_[i], values[variables_.size() + 1 + i]);
    } else {
      point.failure = failures.at(failure_line + std::to_string(row + 1));
    }
    order_.push_back(x);
    points_[x] = std::move(point);
  }
  kept_ = static_cast<int>(order_.size());
}

const StudyPoint* EvaluationStore::find(const std::vector<double>& x) const {
  const auto found = points_.find(x);
  return found == points_.end() ? nullptr : &found->second;
}

void EvaluationStore::add(const std::vector<double>& x, StudyPoint point) {
  if (points_.emplace(x, std::move(point)).second) order_.push_back(x);
  changed_ = true;
  if (std::chrono::steady_clock::now() - saved_ > evaluations_interval) save();
}

Csv EvaluationStore::table() const {
  Csv csv;
  csv.header = {{"annulus_version", version()}, {"inputs_id", id_}};
  csv.columns = variables_;
  csv.columns.emplace_back("failed");
  csv.columns.insert(csv.columns.end(), figures_.begin(), figures_.end());
  for (const auto& x : order_) {
    const auto& point = points_.at(x);
    auto row = x;
    row.push_back(point.failure.empty() ? 0.0 : 1.0);
    for (const auto& key : figures_) row.push_back(point.value(key));
    csv.rows.push_back(std::move(row));
    if (!point.failure.empty()) csv.header.emplace_back(failure_line + std::to_string(csv.rows.size()), point.failure);
  }
  return csv;
}

void EvaluationStore::save() {
  if (!changed_ || !store_) return;
  store_->keep(searches, id_, table().text());
  saved_ = std::chrono::steady_clock::now();
  changed_ = false;
}

}  // namespace annulus::app
