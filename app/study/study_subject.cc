#include "app/study/study_subject.h"

#include "app/pipeline.h"
#include "core/errors.h"

namespace annulus::app {

RunOptions StudySubject::options_in(const std::string& folder) const {
  RunOptions inside = options();
  if (inside.tables) inside.tables = *inside.tables / folder;
  inside.out /= folder;
  inside.for_study = true;
  return inside;
}

std::filesystem::path StudySubject::folder(std::size_t variant) const {
  return options().out / variants().at(variant) / "dynamics";
}

StudyPoint evaluate(const ChangedModel& model, bool quick) {
  try {
    return model.answer(quick);
  } catch (const Error& error) {
    std::string reason = error.what();
    for (auto& c : reason) {
      if (c == '\n' || c == '\r') c = ' ';
    }
    return {{}, {}, std::move(reason)};
  }
}

}  // namespace annulus::app
