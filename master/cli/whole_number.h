// A check for options of 64 bits: CLI11 by itself takes -1 and 2^64 for the largest number.
#pragma once
#include <CLI/CLI.hpp>
#include <charconv>
#include <cstdint>
#include <string>

namespace rayfarm {

inline CLI::Validator whole_number() {
  const auto complaint = [](const std::string& text) -> std::string {
    std::uint64_t number = 0;
    const char* end = text.data() + text.size();
    const auto [stop, error] = std::from_chars(text.data(), end, number);
    return error == std::errc{} && stop == end ? "" : text + " is no whole number of 0 or more";
  };
  return {complaint, "", "whole number"};
}

}  // namespace rayfarm
