#include "slam/io/text_reader.hpp"

#include <charconv>
#include <cstdlib>
#include <cstring>
#include <type_traits>

#include <fmt/format.h>

#include "slam/core/error.hpp"
#include "slam/io/input_file.hpp"

namespace planum {
namespace {

bool is_space(char c) { return c == ' ' || c == '\t'; }

/// A number too large or too small for its type becomes infinite or zero, as IEEE 754 rounds it.
template <class Number>
Number rounded_number(const char* begin, const char* end) {
  const std::string word(begin, end);
  if constexpr (std::is_same_v<Number, float>) return std::strtof(word.c_str(), nullptr);
  return static_cast<Number>(std::strtod(word.c_str(), nullptr));
}

/// std::from_chars that takes a plus sign too.
template <class Number>
std::from_chars_result parse(const char* begin, const char* end, Number& value) {
  const bool plus = end - begin > 1 && *begin == '+' && begin[1] != '-';
  return std::from_chars(plus ? begin + 1 : begin, end, value);
}

}  // namespace

TextReader::TextReader(const std::filesystem::path& path) : TextReader(path, read_file(path)) {}

TextReader::TextReader(const std::filesystem::path& path, std::string text)
    : path_(path), text_(std::move(text)) {
  constexpr std::string_view byte_order_mark = "\xEF\xBB\xBF";
  next_ = text_.data();
  if (text_.starts_with(byte_order_mark)) next_ += byte_order_mark.size();
  at_ = line_begin_ = line_end_ = next_;
}

bool TextReader::next_line() {
  const char* const end = text_.data() + text_.size();
  while (next_ < end) {
    const auto left = static_cast<std::size_t>(end - next_);
    const auto* newline = static_cast<const char*>(std::memchr(next_, '\n', left));
    line_begin_ = at_ = next_;
    line_end_ = newline ? newline : end;
    next_ = newline ? newline + 1 : end;
    if (line_end_ > line_begin_ && line_end_[-1] == '\r') --line_end_;
    ++line_number_;
    while (at_ < line_end_ && is_space(*at_)) ++at_;
    if (at_ < line_end_) return true;
  }
  return false;
}

bool TextReader::next_data_line() {
  while (next_line())
    if (!is_comment()) return true;
  return false;
}

bool TextReader::is_comment() const {
  const char* first = line_begin_;
  while (first < line_end_ && is_space(*first)) ++first;
  return first < line_end_ && *first == '#';
}

bool TextReader::at_end_of_line() {
  while (at_ < line_end_ && is_space(*at_)) ++at_;
  if (at_ < line_end_ && *at_ == '#') at_ = line_end_;
  return at_ == line_end_;
}

std::string_view TextReader::word() {
  if (at_end_of_line()) return {};
  const char* const begin = at_;
  while (at_ < line_end_ && !is_space(*at_)) ++at_;
  return {begin, at_};
}

std::string_view TextReader::rest() {
  while (at_ < line_end_ && is_space(*at_)) ++at_;
  const char* end = line_end_;
  while (end > at_ && is_space(end[-1])) --end;
  const std::string_view result(at_, end);
  at_ = line_end_;
  return result;
}

template <class Number>
Number TextReader::parsed_number() {
  const char* const begin = at_;
  Number value = 0;
  const auto result = parse(begin, line_end_, value);
  const bool whole_word = result.ptr == line_end_ || is_space(*result.ptr);
  if (!whole_word || result.ec == std::errc::invalid_argument)
    fail(fmt::format("expected a {}number, got {}", std::is_integral_v<Number> ? "whole " : "",
                     in_quotes(word())));
  at_ = result.ptr;
  if (result.ec == std::errc::result_out_of_range) {
    if constexpr (std::is_integral_v<Number>)
      fail(fmt::format("{} is too large", in_quotes({begin, at_})));
    else
      value = rounded_number<Number>(begin, at_);
  }
  return value;
}

double TextReader::number() {
  if (at_end_of_line()) fail("expected a number, got the end of the line");
  return parsed_number<double>();
}

long long TextReader::integer() {
  if (at_end_of_line()) fail("expected a whole number, got the end of the line");
  return parsed_number<long long>();
}

std::size_t TextReader::numbers(std::span<double> values) {
  std::size_t count = 0;
  while (count < values.size() && !at_end_of_line()) values[count++] = parsed_number<double>();
  return count;
}

void TextReader::append_numbers(std::vector<float>& values) {
  while (!at_end_of_line()) values.push_back(parsed_number<float>());
}

void TextReader::all_numbers(std::span<double> values, std::string_view names) {
  const std::size_t count = numbers(values);
  if (count < values.size())
    fail(fmt::format("expected {} numbers ({}), got {}", values.size(), names, count));
  if (!at_end_of_line())
    fail(fmt::format("expected {} numbers ({}), but the line goes on with {}", values.size(), names,
                     in_quotes(word())));
}

void TextReader::fail(std::string_view message) const {
  throw Error(fmt::format("{}:{}: {}", path_.string(), line_number_, message));
}

std::optional<double> number_from(std::string_view word) {
  const char* const end = word.data() + word.size();
  double value = 0;
  const auto result = parse(word.data(), end, value);
  if (result.ptr != end || result.ec == std::errc::invalid_argument) return std::nullopt;
  if (result.ec == std::errc::result_out_of_range) return rounded_number<double>(word.data(), end);
  return value;
}

std::string in_quotes(std::string_view word) {
  constexpr std::size_t max_letters = 40;
  std::string result = "\"";
  for (const char c : word.substr(0, max_letters)) result += c >= ' ' && c <= '~' ? c : '?';
  return result + (word.size() > max_letters ? "...\"" : "\"");
}

}  // namespace planum
