// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// Memory for one tile's work: blocks are handed out in order and all given back at once. After the first few tiles
// one chunk is large enough and nothing is allocated any more.
#pragma once

#include <algorithm>
#include <cstddef>
#include <memory>
#include <new>
#include <vector>

namespace thalweg {

class Arena {
 public:
  static constexpr std::size_t kAlignment = 64;

  /// Uninitialised room for `count` trivial objects, aligned to a cache line; valid until reset().
  template <class T>
  [[nodiscard]] T* take(std::size_t count) {
    const std::size_t bytes = (count * sizeof(T) + kAlignment - 1) / kAlignment * kAlignment;
    if (chunks_.empty() || used_ + bytes > chunks_.back().size) grow(bytes);
    std::byte* block = chunks_.back().memory.get() + used_;
    used_ += bytes;
    return new (block) T[count];
  }

  /// Gives everything back; several chunks become one, so that a warm arena never allocates.
  void reset() {
    if (chunks_.size() > 1) {
      std::size_t total = 0;
      for (const Chunk& chunk : chunks_) total += chunk.size;
      chunks_.clear();
      add(total);
    }
    used_ = 0;
  }

 private:
  struct Free {
    void operator()(std::byte* memory) const { ::operator delete[](memory, std::align_val_t{kAlignment}); }
  };
  struct Chunk {
    std::unique_ptr<std::byte[], Free> memory;
    std::size_t size;
  };

  void grow(std::size_t bytes) {
    add(std::max(bytes, chunks_.empty() ? std::size_t{1} << 18 : 2 * chunks_.back().size));
    used_ = 0;
  }
  void add(std::size_t bytes) {
    chunks_.push_back({std::unique_ptr<std::byte[], Free>(
                           static_cast<std::byte*>(::operator new[](bytes, std::align_val_t{kAlignment}))),
                       bytes});
  }

  std::vector<Chunk> chunks_;
  std::size_t used_ = 0;
};

}  // namespace thalweg
