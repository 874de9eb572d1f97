#include "core/figure.h"

#include <algorithm>

#include "core/errors.h"

namespace annulus {

const FigureSpec* find_figure(const std::vector<FigureSpec>& specs, const std::string& key) {
  const auto found = std::find_if(specs.begin(), specs.end(), [&](const FigureSpec& spec) { return spec.key == key; });
  return found == specs.end() ? nullptr : &*found;
}

std::vector<FigureSpec> joined_figures(const std::vector<std::vector<FigureSpec>>& lists) {
  std::vector<FigureSpec> all;
  for (const auto& list : lists) all.insert(all.end(), list.begin(), list.end());
  return all;
}

std::vector<std::string> figure_keys(const std::vector<FigureSpec>& specs) {
  std::vector<std::string> keys;
  keys.reserve(specs.size());
  for (const auto& spec : specs) keys.push_back(spec.key);
  return keys;
}

void FigureSet::set(const std::string& key, const Figure& figure, const ErrorParts& parts) {
  const auto found = std::find_if(entries_.begin(), entries_.end(), [&](const Entry& e) { return e.key == key; });
  if (found == entries_.end())
    entries_.push_back({key, figure, parts});
  else
    *found = {key, figure, parts};
}

void FigureSet::set_spread(const std::string& key, const Spread& spread) {
  for (auto& entry : entries_)
    if (entry.key == key) entry.spread = spread;
}

void FigureSet::add(const FigureSet& other) {
  for (const auto& e : other.entries_) {
    set(e.key, e.figure, e.parts);
    if (e.spread) set_spread(e.key, *e.spread);
  }
}

const FigureSet::Entry* FigureSet::find(const std::string& key) const {
  const auto found = std::find_if(entries_.begin(), entries_.end(), [&](const Entry& e) { return e.key == key; });
  return found == entries_.end() ? nullptr : &*found;
}

Figure FigureSet::figure(const std::string& key) const {
  const auto* found = find(key);
  return found ? found->figure : Figure{not_known, not_known};
}

FigureRow::FigureRow(const std::vector<FigureSpec>& specs, const FigureSet& figures) : FigureRow(specs) {
  for (const auto& e : figures.entries()) set(e.key, e.figure.value);
}

void FigureRow::set(const std::string& key, double value) {
  for (std::size_t i = 0; i < values_.size(); ++i) {
    if ((*specs_)[i].key != key) continue;
    values_[i] = value;
    return;
  }
  throw InternalError("internal error: the result " + key + " is not declared");
}

double FigureRow::value(const std::string& key) const {
  for (std::size_t i = 0; i < values_.size(); ++i)
    if ((*specs_)[i].key == key) return values_[i];
  return not_known;
}

}  // namespace annulus
