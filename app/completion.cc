#include "app/completion.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <vector>

#include "core/errors.h"

namespace annulus::app {

namespace {

struct Command {
  std::string name, what;
  std::vector<std::pair<std::string, std::string>> options{};  ///< "--threads" and what it does
};

std::vector<const CLI::App*> parts_of(const CLI::App& command) {
  return command.get_subcommands([](const CLI::App*) { return true; });
}

/// With those of its parts.
void add_options(const CLI::App& command, std::vector<std::pair<std::string, std::string>>& options) {
  const auto add = [&](const std::string& name, const CLI::Option& option) {
    if (std::none_of(options.begin(), options.end(), [&](const auto& known) { return known.first == name; }))
      options.emplace_back(name, option.get_description());
  };
  for (const auto* option : command.get_options()) {
    for (const auto& name : option->get_lnames()) add("--" + name, *option);
    for (const auto& name : option->get_snames()) add("-" + name, *option);
  }
  for (const auto* part : parts_of(command)) add_options(*part, options);
}

std::vector<Command> commands_of(const CLI::App& app) {
  std::vector<Command> list;
  for (const auto* sub : parts_of(app)) {
    auto& command = list.emplace_back(Command{sub->get_name(), sub->get_description()});
    add_options(*sub, command.options);
  }
  return list;
}

/// As text between single quotes of a shell.
std::string quoted(std::string text) {
  for (std::size_t at = 0; (at = text.find('\'', at)) != std::string::npos; at += 4) text.replace(at, 1, "'\\''");
  return "'" + text + "'";
}

std::string bash_script(const std::vector<Command>& commands) {
  std::string names, cases;
  for (const auto& c : commands) {
    names += (names.empty() ? "" : " ") + c.name;
    std::string options;
    for (const auto& [option, what] : c.options) options += (options.empty() ? "" : " ") + option;
    cases += fmt::format("    {}) words='{}' ;;\n", c.name, options);
  }
  return fmt::format(R"(# bash completion of annulus
_annulus() {{
  local current=${{COMP_WORDS[COMP_CWORD]}} words=''
  COMPREPLY=()
  if [ "$COMP_CWORD" -eq 1 ]; then
    COMPREPLY=($(compgen -W '{} --help --version' -- "$current"))
    return
  fi
  case ${{COMP_WORDS[1]}} in
{}  esac
  case $current in
    -*) COMPREPLY=($(compgen -W "$words" -- "$current")) ;;
    *) COMPREPLY=($(compgen -f -- "$current")) ;;
  esac
}}
complete -o filenames -F _annulus annulus
)",
                     names, cases);
}

std::string zsh_script(const std::vector<Command>& commands) {
  const auto plain = [](std::string text) {
    for (char& c : text)
      if (c == '[' || c == ']' || c == ':') c = ' ';
    return text;
  };
  std::string names, cases;
  for (const auto& c : commands) {
    names += fmt::format("    {}\n", quoted(c.name + ":" + plain(c.what)));
    cases += fmt::format("    {}) _arguments", c.name);
    for (const auto& [option, what] : c.options) cases += " " + quoted(fmt::format("{}[{}]", option, plain(what)));
    cases += " '*:file:_files' ;;\n";
  }
  return fmt::format(R"(#compdef annulus
_annulus() {{
  local -a commands
  commands=(
{}  )
  if (( CURRENT == 2 )); then
    _describe command commands
    return
  fi
  local command=$words[2]
  shift words
  (( CURRENT-- ))
  case $command in
{}  esac
}}
_annulus "$@"
)",
                     names, cases);
}

std::string fish_script(const std::vector<Command>& commands) {
  std::string text = "# fish completion of annulus\n";
  for (const auto& c : commands) {
    text += fmt::format("complete -c annulus -n __fish_use_subcommand -f -a {} -d {}\n", c.name, quoted(c.what));
    for (const auto& [option, what] : c.options) {
      const bool is_long = option.starts_with("--");
      text += fmt::format("complete -c annulus -n '__fish_seen_subcommand_from {}' {} {} -d {}\n", c.name,
                          is_long ? "-l" : "-s", option.substr(is_long ? 2 : 1), quoted(what));
    }
  }
  return text;
}

}  // namespace

std::string completion_script(const CLI::App& app, const std::string& shell) {
  const auto commands = commands_of(app);
  if (shell == "bash") return bash_script(commands);
  if (shell == "zsh") return zsh_script(commands);
  if (shell == "fish") return fish_script(commands);
  throw InputError(shell + ": there is no completion for this shell; there is for bash, zsh and fish");
}

}  // namespace annulus::app
