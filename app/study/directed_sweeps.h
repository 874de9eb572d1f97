#pragma once

#include <string>
#include <vector>

#include "app/model/study_cases.h"
#include "app/model/study_result.h"
#include "app/study/study_points.h"
#include "app/study/study_subject.h"

/// Sweeps whose motions depend on each other: followed in time from value to value, and branches between the ends.
namespace annulus::app {

enum class SweepOrder { rising, falling };

/// The motion of each value followed in time from the end of that before, by variant; points in the order of `cases`.
/// After a failure the next value starts from equilibrium.
[[nodiscard]] CasePoints run_in_order(const StudySubject& subject, const std::vector<StudyCase>& cases,
                                      SweepOrder order, const std::string& label);

/// The branches of periodic motions between the ends of a sweep, by variant.
[[nodiscard]] std::vector<SweepBranches> find_branches(const StudySubject& subject, std::size_t sweep);

}  // namespace annulus::app
