#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace planum {

/// Reads text line by line and number by number; whatever is wrong is an Error `path:line: ...`.
/// The file is read in one go. Lines end with LF or CRLF, the last one may end with the file; words
/// are separated by spaces and tabs; blank lines are passed over. A word that begins with '#'
/// starts a comment. `nan` and `inf` are numbers.
class TextReader {
 public:
  explicit TextReader(const std::filesystem::path& path);

  /// Reads `text`; `path` is only for messages.
  TextReader(const std::filesystem::path& path, std::string text);

  TextReader(const TextReader&) = delete;
  TextReader& operator=(const TextReader&) = delete;

  /// Goes to the next line, comments included. False at the end of the file.
  bool next_line();

  /// Goes to the next line that is not a comment. False at the end of the file.
  bool next_data_line();

  /// Whether the current line is a comment and nothing else.
  bool is_comment() const;

  /// The current line without its end.
  std::string_view line() const { return {line_begin_, line_end_}; }
  std::size_t line_number() const { return line_number_; }  ///< counted from 1; 0 before the first
  const std::filesystem::path& path() const { return path_; }

  /// Whether only spaces or a comment are left of the line.
  bool at_end_of_line();

  /// The next word of the line; empty at its end.
  std::string_view word();

  /// What is left of the line, without spaces around it; '#' has no meaning here.
  std::string_view rest();

  /// The next number of the line; throws if there is none.
  double number();

  /// The next whole number of the line; throws if there is none.
  long long integer();

  /// Fills `values` with the next numbers of the line; returns how many there were.
  std::size_t numbers(std::span<double> values);

  /// All numbers left on the line.
  void append_numbers(std::vector<float>& values);

  /// The line must go on with as many numbers as `values` has, and end. `names` is for the message.
  void all_numbers(std::span<double> values, std::string_view names);

  /// Throws Error `path:line: message`.
  [[noreturn]] void fail(std::string_view message) const;

 private:
  template <class Number>
  Number parsed_number();

  std::filesystem::path path_;
  std::string text_;
  const char* at_ = nullptr;
  const char* line_begin_ = nullptr;
  const char* line_end_ = nullptr;
  const char* next_ = nullptr;
  std::size_t line_number_ = 0;
};

/// The number that a word is, if it is one.
std::optional<double> number_from(std::string_view word);

/// A word from a file as it may stand in a message: in quotes, shortened, only printable letters.
std::string in_quotes(std::string_view word);

}  // namespace planum
