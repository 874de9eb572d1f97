#include "app/study/study_points.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "app/model/run_options.h"
#include "app/process/progress.h"
#include "app/results/content_id.h"
#include "core/errors.h"
#include "core/log.h"
#include "core/parallel.h"
#include "core/result_store.h"

namespace annulus::app {

namespace {

constexpr auto save_interval = std::chrono::seconds(2);  // what an interruption costs
constexpr int least_work = 20;                           // times the time of a save between two of them

std::string failure_line(std::size_t number) { return fmt::format("failure_{}", number); }

// JSON knows neither NaN (not known: null) nor infinity (an unbounded share: a text).
Json exact_number(double x) {
  if (std::isnan(x)) return nullptr;
  return std::isfinite(x) ? Json(x) : Json(x > 0 ? "inf" : "-inf");
}
double exact_number(const Json& json) {
  if (json.is_null()) return not_known;
  if (json.is_string()) return (json == "-inf" ? -1 : 1) * std::numeric_limits<double>::infinity();
  return json.get<double>();
}

Json row_json(const FigureRow& row, const std::vector<FigureSpec>& figures) {
  if (row.empty()) return nullptr;
  Json json;
  for (const auto& figure : figures) json[figure.key] = exact_number(row.value(figure.key));
  return json;
}

FigureRow row_of(const Json& json, const std::vector<FigureSpec>& figures) {
  if (json.is_null()) return {};
  FigureRow row(figures);
  for (const auto& figure : figures) row.set(figure.key, exact_number(json.at(figure.key)));
  return row;
}

}  // namespace

StudyPoint attempted(const std::function<StudyPoint()>& respond) {
  try {
    return respond();
  } catch (const Error& error) {
    std::string reason = error.what();
    std::replace_if(
        reason.begin(), reason.end(), [](char c) { return c == '\n' || c == '\r'; }, ' ');
    return {.failure = std::move(reason)};
  }
}

std::string variant_words(const StudySubject& subject, std::size_t variant) {
  const auto& name = subject.variants().at(variant);
  return name.empty() ? "" : fmt::format(", {} '{}'", variant_word(subject.scene().stage.kind), name);
}

std::size_t warn_of_failures(const StudySubject& subject, const std::vector<StudyCase>& cases,
                             const CasePoints& points) {
  std::size_t failed = 0;
  for (std::size_t variant = 0; variant < points.variants.size(); ++variant)
    for (std::size_t i = 0; i < cases.size(); ++i) {
      const auto& point = points.variants[variant][i];
      if (point.failure.empty()) continue;
      ++failed;
      log::warn(fmt::format("{}{}: {}", cases[i].where, variant_words(subject, variant), point.failure));
    }
  return failed;
}

CasePoints run_cases(const StudySubject& subject, const std::vector<StudyCase>& cases, const std::string& label) {
  const auto& figures = subject.figures();
  const std::size_t variants = subject.variants().size(), n = cases.size();
  CasePoints result;
  result.variants.assign(variants, std::vector<StudyPoint>(n));
  std::vector<std::string> failures(n);
  for (std::size_t i = 0; i < n; ++i) {
    try {
      result.tables += subject.prepare(cases[i]) ? 1 : 0;
    } catch (const SolverError& error) {
      failures[i] = error.what();
    }
  }
  TaskProgress progress(label, n * variants);
  for_each_task(n * variants, subject.options().threads, [&](std::size_t task) {
    const std::size_t i = task / variants, variant = task % variants;
    auto& point = result.variants[variant][i];
    point.failure = failures[i];
    if (failures[i].empty()) {
      const auto model = subject.model(cases[i], variant);
      point = study_point_of(
          cached_response(subject.options(), "study_points", model->id(),
                          [&] { return to_json(attempted([&] { return model->answer(Answer::all); }), figures); }),
          figures);
    }
    progress.done();
  });
  const std::size_t failed = warn_of_failures(subject, cases, result);
  progress.finish(fmt::format("{} responses{}", n * variants, failed ? fmt::format(", {} failed", failed) : ""));
  return result;
}

Json to_json(const StudyPoint& point, const std::vector<FigureSpec>& figures) {
  Json json = {{"failure", point.failure}};
  if (!point.failure.empty()) return json;
  json["figures"] = row_json(point.figures, figures);
  json["poincare_N_m"] = Json::array();
  for (const auto& p : point.poincare)
    json["poincare_N_m"].push_back(Json::array({exact_number(p.force), exact_number(p.deflection)}));
  return json;
}

StudyPoint study_point_of(const Json& json, const std::vector<FigureSpec>& figures) {
  StudyPoint point{.failure = json.at("failure")};
  if (!point.failure.empty()) return point;
  point.figures = row_of(json.at("figures"), figures);
  for (const auto& p : json.at("poincare_N_m"))
    point.poincare.push_back({exact_number(p.at(0)), exact_number(p.at(1))});
  return point;
}

Json to_json(const Design& design, const std::vector<FigureSpec>& figures) {
  Json json = {{"point", to_json(design.point, figures)}, {"starts", nullptr}};
  if (const auto& s = design.starts)
    json["starts"] = {{"starts", s->starts},
                      {"motions", s->motions},
                      {"not_steady", s->not_steady},
                      {"low", row_json(s->low, figures)},
                      {"high", row_json(s->high, figures)}};
  return json;
}

Design design_of(const Json& json, const std::vector<double>& x, const std::vector<FigureSpec>& figures) {
  Design design{.x = x, .objective = 0, .point = study_point_of(json.at("point"), figures), .starts = std::nullopt};
  if (const auto& s = json.at("starts"); !s.is_null())
    design.starts = StartSpread{.starts = s.at("starts"),
                                .motions = s.at("motions"),
                                .low = row_of(s.at("low"), figures),
                                .high = row_of(s.at("high"), figures),
                                .not_steady = s.at("not_steady")};
  return design;
}

Json cached_response(const RunOptions& options, const std::string& kind, const std::string& id,
                     const std::function<Json()>& make) {
  const auto& store = options.store;
  const auto cached = store ? store->find(kind, id) : std::nullopt;
  count_reuse(options, study_responses, cached ? 1 : 0, cached ? 0 : 1);
  if (cached) return Json::parse(*cached);
  auto made = make();
  if (store) store->keep(kind, id, made.dump());
  return made;
}

Csv PointColumns::empty_table() const {
  Csv csv{.header = {{"annulus_version", version()}}, .columns = inputs, .rows = {}};
  csv.header.insert(csv.header.end(), header.begin(), header.end());
  csv.columns.emplace_back("failed");
  csv.columns.insert(csv.columns.end(), results.begin(), results.end());
  return csv;
}

void PointColumns::add(Csv& csv, std::size_t number, const std::vector<double>& values, const StudyPoint& point) const {
  auto& row = csv.rows.emplace_back(values);
  row.push_back(point.failure.empty() ? 0.0 : 1.0);
  for (const auto& key : results) row.push_back(point.value(key));
  if (!point.failure.empty()) csv.header.emplace_back(failure_line(number), point.failure);
}

PointTable::PointTable(const ResultStore* store, const char* kind, std::string id, PointColumns columns,
                       const std::vector<FigureSpec>& specs, Work work)
    : store_(store),
      kind_(kind),
      id_(std::move(id)),
      columns_(std::move(columns)),
      specs_(specs),
      work_(work),
      next_save_(std::chrono::steady_clock::now() + (work == Work::alone ? save_interval : std::chrono::seconds(0))) {
  if (!store_) return;
  if (const auto own = store_->find_own(kind_, id_)) add(Csv::parse(*own, kind_));
  own_ = order_;
  read_others();
}

void PointTable::read_others() {
  const auto start = std::chrono::steady_clock::now();
  for (const auto& others : store_->find_others(kind_, id_)) add(Csv::parse(others, kind_));
  const auto end = std::chrono::steady_clock::now();
  next_read_ = end + least_work * (end - start);
}

void PointTable::add(const Csv& csv) {
  const std::map<std::string, std::string> failures(csv.header.begin(), csv.header.end());
  const auto n = columns_.inputs.size();
  std::size_t number = 0;
  for (const auto& row : csv.rows) {
    ++number;
    const std::vector<double> x(row.begin(), row.begin() + static_cast<std::ptrdiff_t>(n));
    const auto [entry, is_new] = points_.emplace(x, StudyPoint{});
    if (!is_new) continue;  // several workers had it
    order_.push_back(x);
    unasked_.insert(x);
    auto& point = entry->second;
    if (row[n] != 0) {
      point.failure = failures.at(failure_line(number));
      continue;
    }
    point.figures = FigureRow(specs_);
    for (std::size_t i = 0; i < columns_.results.size(); ++i) point.figures.set(columns_.results[i], row[n + 1 + i]);
  }
}

const StudyPoint* PointTable::find(const std::vector<double>& inputs) {
  const auto known = points_.find(inputs);
  if (known == points_.end()) return nullptr;
  if (unasked_.erase(inputs) > 0) ++reused_;
  return &known->second;
}

const StudyPoint& PointTable::point(const std::vector<double>& inputs, const std::function<StudyPoint()>& make) {
  {
    const std::scoped_lock guard(lock_);
    if (const auto* known = find(inputs)) return *known;
    if (work_ == Work::together && store_ && std::chrono::steady_clock::now() > next_read_) {
      read_others();
      if (const auto* known = find(inputs)) return *known;
    }
  }
  auto made = make();
  const std::scoped_lock guard(lock_);
  const auto [point, added] = points_.emplace(inputs, std::move(made));
  if (added) {
    order_.push_back(inputs);
    own_.push_back(inputs);
  }
  changed_ = true;
  if (std::chrono::steady_clock::now() > next_save_) save_locked();
  return point->second;
}

Csv PointTable::table() const { return table_of(order_); }

Csv PointTable::table_of(const std::vector<std::vector<double>>& list) const {
  auto csv = columns_.empty_table();
  for (const auto& x : list) columns_.add(csv, csv.rows.size() + 1, x, points_.at(x));
  return csv;
}

void PointTable::save() {
  const std::scoped_lock guard(lock_);
  save_locked();
}

void PointTable::save_locked() {
  if (!changed_ || !store_) return;
  const auto start = std::chrono::steady_clock::now();
  store_->keep(kind_, id_, table_of(own_).text());
  const auto end = std::chrono::steady_clock::now();
  const std::chrono::steady_clock::duration least = work_ == Work::together ? std::chrono::seconds(0) : save_interval;
  next_save_ = end + std::max(least, least_work * (end - start));
  changed_ = false;
}

}  // namespace annulus::app
