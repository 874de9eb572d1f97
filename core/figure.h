#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/error_parts.h"
#include "core/not_known.h"

namespace annulus {

/// A result with its estimated absolute numerical error, both in the unit of the result. NaN: not known.
struct Figure {
  double value = 0;
  double error = 0;
};

/// What a result is where inputs are not known, in the unit of the result: quantiles of samples.
struct Spread {
  double low = 0, median = 0, high = 0;  ///< 5 %, 50 %, 95 %
  int samples = 0;

  [[nodiscard]] Spread scaled(double scale) const { return {scale * low, scale * median, scale * high, samples}; }
};

/// Which change of a result an engineer wants.
enum class Better { neither, smaller, larger };

/// Whether the wanted accuracy of a scene covers the error of a result. The accuracy is one of the stiffness. While the
/// teeth stay in contact the motion follows the stiffness no further than in proportion; where they separate, it may.
enum class Guarantee { none, while_in_contact, always };

/// How much has to be computed until a result is known.
enum class FigureEffort {
  tables,  ///< stiffness tables alone
  forces,  ///< a response of the lumped model
  motion,  ///< a response with the motion of its bodies, or its modes
};

/// The declaration of a result. Everything that shows, stores, compares or varies results reads it.
struct FigureSpec {
  std::string key;       ///< in all files: "sun_planet_load_sharing_averaged", with the SI unit of the value at its end
  std::string title;     ///< "Load sharing of the sun meshes, averaged over a mesh cycle"
  std::string symbol{};  ///< "K_γ"
  std::string unit{};    ///< in which it is shown: "µm"
  double scale = 1;      ///< from SI to that unit
  std::string axis{};    ///< label of a plot axis: "rms, µm"; empty: the unit
  std::string definition{};  ///< one sentence, with the formula where there is one
  std::string term{};        ///< key of the word it shows in docs/definitions.md; empty: none
  Better better = Better::neither;
  FigureEffort effort = FigureEffort::forces;
  Guarantee guarantee = Guarantee::none;
  std::string quantity{};   ///< results that define the same quantity in different ways share it: "load_sharing"
  int digits = 4;           ///< where no error limits them
  bool headline = false;    ///< in the short table of a run
  bool compared = false;    ///< listed by comparisons of runs
  bool cost_study = false;  ///< its error is measured over the cost (annulus tradeoff)
  bool plotted = false;     ///< over sweeps and grids
  bool spread = false;      ///< in pictures and tables of samples
  bool ordering = false;    ///< orders the variants of a comparison; the first such result decides
  std::string beside{};     ///< key of a result drawn dashed in the same picture

  [[nodiscard]] std::string axis_label() const { return axis.empty() ? unit : axis; }
};

/// The declaration with this key; nullptr when there is none.
[[nodiscard]] const FigureSpec* find_figure(const std::vector<FigureSpec>& specs, const std::string& key);

/// The declarations of all lists, in their order.
[[nodiscard]] std::vector<FigureSpec> joined_figures(const std::vector<std::vector<FigureSpec>>& lists);

[[nodiscard]] std::vector<std::string> figure_keys(const std::vector<FigureSpec>& specs);

/// Results by their keys, in the order in which they were set.
class FigureSet {
 public:
  struct Entry {
    std::string key;
    Figure figure;
    ErrorParts parts{};  ///< of the error, where they are known; all zero otherwise
    std::optional<Spread> spread{};
  };

  /// Replaces a result of the same key.
  void set(const std::string& key, const Figure& figure, const ErrorParts& parts = {});
  /// A value whose error is not known.
  void set(const std::string& key, double value) { set(key, {value, not_known}); }
  /// Of a result that is there.
  void set_spread(const std::string& key, const Spread& spread);
  /// All results of another set.
  void add(const FigureSet& other);

  [[nodiscard]] const Entry* find(const std::string& key) const;  ///< nullptr: it is not there
  [[nodiscard]] Figure figure(const std::string& key) const;      ///< NaN for one that is not there
  [[nodiscard]] double value(const std::string& key) const { return figure(key).value; }

  [[nodiscard]] const std::vector<Entry>& entries() const { return entries_; }
  [[nodiscard]] bool empty() const { return entries_.empty(); }

 private:
  std::vector<Entry> entries_;
};

/// Values of declared results, without their errors, by key: what studies keep of thousands of responses. The
/// declarations are referred to and have to outlive it.
class FigureRow {
 public:
  FigureRow() = default;
  explicit FigureRow(const std::vector<FigureSpec>& specs) : specs_(&specs), values_(specs.size(), not_known) {}
  /// Throws InternalError for a result that is not declared.
  FigureRow(const std::vector<FigureSpec>& specs, const FigureSet& figures);

  /// Throws InternalError for a result that is not declared.
  void set(const std::string& key, double value);
  [[nodiscard]] double value(const std::string& key) const;  ///< NaN for one that is not known
  [[nodiscard]] bool empty() const { return values_.empty(); }

 private:
  const std::vector<FigureSpec>* specs_ = nullptr;
  std::vector<double> values_;  ///< in the order of the declarations
};

}  // namespace annulus
