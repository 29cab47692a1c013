// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// Drives the generated scenes over the points. Highway is used without dynamic dispatch: the vectors are those that
// -march=native offers.
#include "native.h"

#include <algorithm>

#include "native_primitives.h"

HWY_BEFORE_NAMESPACE();
namespace thalweg::bench::native {
namespace {

#include "native_scenes.inl"

constexpr size_t kMostPoints = 2 * hn::MaxLanes(Tag());

template <class Scene>
void value_turn(const float* points, float* value) {
  store(Scene::field(load_points(points)).value, value);
}
template <class Scene>
void gradient_turn(const float* points, float* value, float* gradient) {
  const Field f = Scene::field(load_points(points));
  store(f.value, value);
  store_points({f.gx, f.gy}, gradient);
}

template <class Scene>
void value(const float* points, size_t count, float* out) {
  const size_t width = lanes_per_turn();
  size_t i = 0;
  for (; i + width <= count; i += width) value_turn<Scene>(points + 2 * i, out + i);
  if (i == count) return;
  float tail[2 * kMostPoints] = {}, answers[kMostPoints];
  std::copy(points + 2 * i, points + 2 * count, tail);
  value_turn<Scene>(tail, answers);
  std::copy(answers, answers + (count - i), out + i);
}

template <class Scene>
void gradient(const float* points, size_t count, float* out, float* gradients) {
  const size_t width = lanes_per_turn();
  size_t i = 0;
  for (; i + width <= count; i += width) gradient_turn<Scene>(points + 2 * i, out + i, gradients + 2 * i);
  if (i == count) return;
  float tail[2 * kMostPoints] = {}, answers[kMostPoints], slopes[2 * kMostPoints];
  std::copy(points + 2 * i, points + 2 * count, tail);
  gradient_turn<Scene>(tail, answers, slopes);
  std::copy(answers, answers + (count - i), out + i);
  std::copy(slopes, slopes + 2 * (count - i), gradients + 2 * i);
}

}  // namespace
}  // namespace thalweg::bench::native
HWY_AFTER_NAMESPACE();

namespace thalweg::bench {

std::span<const NativeScene> native_scenes() {
  static constexpr NativeScene kScenes[] = {
      {"small", native::value<native::Small>, native::gradient<native::Small>},
      {"primitives12", native::value<native::Primitives12>, native::gradient<native::Primitives12>},
      {"primitives60", native::value<native::Primitives60>, native::gradient<native::Primitives60>},
  };
  return kScenes;
}

std::size_t native_lanes() { return hwy::HWY_NAMESPACE::Lanes(native::Tag()); }

}  // namespace thalweg::bench
