#pragma once

#include <sys/wait.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

namespace annulus::test {

struct ProgramOutcome {
  int status = -1;
  std::string out, err;
};

inline std::string text_of(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
}

/// Runs the built program in `folder`; what it prints is kept beside the folder, which stays as the program leaves it.
inline ProgramOutcome run_program(const std::filesystem::path& folder, const std::string& arguments) {
  const auto out = folder.string() + ".stdout", err = folder.string() + ".stderr";
  const int raw = std::system(
      ("cd '" + folder.string() + "' && '" ANNULUS_PROGRAM "' " + arguments + " >'" + out + "' 2>'" + err + "'")
          .c_str());
  const ProgramOutcome outcome{WIFEXITED(raw) ? WEXITSTATUS(raw) : -1, text_of(out), text_of(err)};
  std::filesystem::remove(out);
  std::filesystem::remove(err);
  return outcome;
}

}  // namespace annulus::test
