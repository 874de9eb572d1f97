#pragma once

#include <string>
#include <vector>

/// What the words of results mean, once for documents, reports and `annulus explain`.
namespace annulus::app {

struct Definition {
  std::string key;     ///< FigureSpec::term of the results that show it
  std::string symbol;  ///< "K_V"; empty: none
  std::string title;   ///< "Dynamic factor"
  std::string formula;
  std::string text;     ///< sentences
  std::string sources;  ///< "[ISO6336-1, 6.1]" by the keys of docs/references.bib; empty: none
};

[[nodiscard]] const std::vector<Definition>& definitions();
/// By key, symbol ("K_V", "K_gamma") or title, whatever the case; nullptr: there is none.
[[nodiscard]] const Definition* find_definition(const std::string& word);

/// What `annulus explain` says of it.
[[nodiscard]] std::string explain(const Definition& definition);
/// All of them with the results that show them, as Markdown (docs/definitions.md).
[[nodiscard]] std::string definitions_markdown();

}  // namespace annulus::app
