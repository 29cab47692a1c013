// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// Memory that outlives a batch: a call takes what an earlier one left, and leaves it for the next. As many are kept as
// ever ran at once, so that a warm call allocates nothing.
#pragma once

#include <cstddef>
#include <memory>
#include <mutex>
#include <utility>
#include <vector>

namespace thalweg {

template <class T>
class Reused {
 public:
  Reused() : object_(take()) {}
  ~Reused() {
    const std::scoped_lock lock(shelf().mutex);
    shelf().free.push_back(std::move(object_));
  }
  Reused(const Reused&) = delete;
  Reused& operator=(const Reused&) = delete;
  T& operator*() const { return *object_; }
  T* operator->() const { return object_.get(); }

 private:
  struct Shelf {
    std::mutex mutex;
    std::vector<std::unique_ptr<T>> free;
  };
  static Shelf& shelf() {
    static Shelf all;
    return all;
  }
  static std::unique_ptr<T> take() {
    {
      const std::scoped_lock lock(shelf().mutex);
      if (!shelf().free.empty()) {
        std::unique_ptr<T> last = std::move(shelf().free.back());
        shelf().free.pop_back();
        return last;
      }
    }
    return std::make_unique<T>();
  }

  std::unique_ptr<T> object_;
};

/// Room for `count` entries that the caller did not bring.
template <class T>
T* room(std::vector<T>& memory, T* asked, std::size_t count) {
  if (asked != nullptr || count == 0) return asked;
  if (memory.size() < count) memory.resize(count);
  return memory.data();
}

}  // namespace thalweg
