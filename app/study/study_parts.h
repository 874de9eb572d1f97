#pragma once

#include <functional>
#include <string>
#include <vector>

#include "app/study/study_subject.h"

/// Studies in parts that workers compute by themselves, on one machine or many. What a part finds stays in the store of
/// results; a run that looks there finds everything done.
namespace annulus::app {

struct StudyPart {
  std::string study;        ///< "[[sweep]] 1", as in the scene
  std::string description;  ///< "value 7 of 20 (stage.power_kW = 900)", "samples 1 to 100"
  double seconds = 0;       ///< rough processor time
  /// How many workers can compute it together. All workers take part in one of more than one.
  int workers = 1;
};

/// The parts of all studies of a scene, in a fixed order. Computes nothing.
[[nodiscard]] std::vector<StudyPart> study_parts(const Scene& scene);

/// Computes those parts, by their places in study_parts(), study after study; `done` gets the places of a study as
/// soon as their results are in the store. Failed points are results. Throws what a run of the studies throws.
void compute_parts(const StudySubject& subject, const std::vector<std::size_t>& places,
                   const std::function<void(const std::vector<std::size_t>&)>& done);

/// Which parts each of so many workers computes: places by worker, rising, so that the predicted times are even. Parts
/// that can be computed together are those of all.
[[nodiscard]] std::vector<std::vector<std::size_t>> shares(const std::vector<StudyPart>& parts, int workers);
/// The longest predicted time of a worker, s.
[[nodiscard]] double longest_share(const std::vector<StudyPart>& parts, int workers);

}  // namespace annulus::app
