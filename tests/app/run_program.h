#pragma once

#include <sys/wait.h>

#include <cstdlib>
#include <filesystem>
#include <string>

#include "core/files.h"

namespace annulus::test {

struct ProgramOutcome {
  int status = -1;
  std::string out, err;
};

/// Runs the built program in `folder`; what it prints is kept beside the folder, which stays as the program leaves it.
/// `environment`: "NAME='value'", set for it alone. Results are cached in OUT/cache unless it says otherwise.
inline ProgramOutcome run_program(const std::filesystem::path& folder, const std::string& arguments,
                                  const std::string& environment = "") {
  const auto out = folder.string() + ".stdout", err = folder.string() + ".stderr";
  const int raw = std::system(("cd '" + folder.string() + "' && ANNULUS_CACHE= " + environment +
                               " '" ANNULUS_PROGRAM "' " + arguments + " >'" + out + "' 2>'" + err + "'")
                                  .c_str());
  const ProgramOutcome outcome{WIFEXITED(raw) ? WEXITSTATUS(raw) : -1, read_file(out), read_file(err)};
  std::filesystem::remove(out);
  std::filesystem::remove(err);
  return outcome;
}

}  // namespace annulus::test
