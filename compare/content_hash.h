// The name of a cache's entry: a hash of all that its content depends on.
#pragma once

#include <fmt/format.h>

#include <cstdint>
#include <cstring>
#include <fstream>
#include <string>
#include <type_traits>
#include <vector>

namespace arealab {

// FNV-1a over 64-bit words, in two lanes that start apart and turn differently; not against malice.
class ContentHash {
 public:
  void Bytes(const void* data, std::size_t size) {
    const auto* bytes = static_cast<const unsigned char*>(data);
    while (size > 0) {
      std::uint64_t word = 0;
      std::size_t step = size < sizeof word ? size : sizeof word;
      std::memcpy(&word, bytes, step);
      bytes += step;
      size -= step;
      Word(word);
    }
  }
  template <typename T>
  void Value(const T& value) {
    static_assert(std::is_arithmetic_v<T> || std::is_enum_v<T>);
    Bytes(&value, sizeof value);
  }
  void Text(const std::string& text) {
    Value(text.size());
    Bytes(text.data(), text.size());
  }
  // The running program: its code, and the shader text and tables in it.
  void Program() {
    std::ifstream program("/proc/self/exe", std::ios::binary);
    for (std::vector<char> block(1 << 20); program.read(block.data(), static_cast<std::streamsize>(block.size())), program.gcount() > 0;)
      Bytes(block.data(), static_cast<std::size_t>(program.gcount()));
  }
  std::uint64_t low() const { return low_; }
  std::string Name() const { return fmt::format("{:016x}{:016x}", high_, low_); }

 private:
  void Word(std::uint64_t word) {
    constexpr std::uint64_t kPrime = 0x100000001b3;  // of FNV
    low_ = (low_ ^ word) * kPrime;
    low_ ^= low_ >> 32;  // whole words: spread the high bits down, which plain FNV never does
    high_ = (((high_ << 23) | (high_ >> 41)) ^ word) * kPrime;
    high_ ^= high_ >> 29;
  }
  std::uint64_t low_ = 0xcbf29ce484222325, high_ = 0x9ae16a3b2f90404f;
};

}  // namespace arealab
