#include "app/report/text/text.h"

namespace annulus::app {

Text::Text(std::string plain) {
  if (!plain.empty()) runs_.push_back({std::move(plain)});
}
Text::Text(const char* plain) : Text(std::string(plain)) {}
Text::Text(Run run) { runs_.push_back(std::move(run)); }

Text& Text::operator+=(const Text& other) {
  for (const auto& run : other.runs()) {
    if (!runs_.empty() && run.look == Look::plain && runs_.back().look == Look::plain)
      runs_.back().text += run.text;
    else
      runs_.push_back(run);
  }
  return *this;
}

std::string Text::plain() const {
  std::string text;
  for (const auto& run : runs_) text += run.look == Look::line_break ? " " : run.text;
  return text;
}

Text bold(std::string text) { return Text({std::move(text), Text::Look::bold}); }
Text code(std::string text) { return Text({std::move(text), Text::Look::code}); }
Text muted(std::string text) { return Text({std::move(text), Text::Look::muted}); }
Text subscript(std::string text) { return Text({std::move(text), Text::Look::subscript}); }
Text tag(Text::Look look, std::string text) { return Text({std::move(text), look}); }
Text link(std::string text, std::string anchor) { return Text({std::move(text), Text::Look::link, std::move(anchor)}); }
Text line_break() { return Text({"", Text::Look::line_break}); }

Text enumerated(const std::vector<Text>& words) {
  Text text;
  for (std::size_t i = 0; i < words.size(); ++i)
    text += (i == 0 ? Text() : Text(i + 1 == words.size() ? " and " : ", ")) + words[i];
  return text;
}

Text joined(const std::vector<Text>& parts, const Text& between) {
  Text text;
  for (std::size_t i = 0; i < parts.size(); ++i) text += (i == 0 ? Text() : between) + parts[i];
  return text;
}

namespace detail {

namespace {

constexpr char slot_mark = '\x1f';  // no text for readers holds this control character
constexpr char first_slot = '0';

}  // namespace

std::string phrase_slot(std::size_t index) { return {slot_mark, static_cast<char>(first_slot + index)}; }

Text filled_phrase(const std::string& text, const std::vector<Text>& slots) {
  Text filled;
  std::size_t begin = 0;
  for (std::size_t at = 0; (at = text.find(slot_mark, begin)) != std::string::npos;) {
    filled += text.substr(begin, at - begin);
    const std::size_t index = at + 1 < text.size() ? static_cast<std::size_t>(text[at + 1] - first_slot) : slots.size();
    if (index < slots.size()) filled += slots[index];
    begin = std::min(at + 2, text.size());
  }
  return filled += text.substr(begin);
}

}  // namespace detail

}  // namespace annulus::app
