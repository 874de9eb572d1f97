#pragma once

#include <string>
#include <vector>

#include "app/model/study_cases.h"
#include "app/study/study_subject.h"

namespace annulus::app {

/// Points of a list of changed scenes: [variant][case]. Tables are solved first, one after the other with all threads;
/// then the responses, in parallel. A table that cannot be solved fails its points.
struct CasePoints {
  std::vector<std::vector<StudyPoint>> variants;
  int tables = 0;  ///< cases that needed tables of their own
};
[[nodiscard]] CasePoints run_cases(const StudySubject& subject, const std::vector<StudyCase>& cases,
                                   const std::string& label);

}  // namespace annulus::app
