#pragma once

#include <string>

namespace CLI {
class App;
}

namespace annulus::app {

/// A script that completes the commands and options of `app`, and names of files, for bash, zsh or fish. Throws
/// InputError for another shell.
[[nodiscard]] std::string completion_script(const CLI::App& app, const std::string& shell);

}  // namespace annulus::app
