// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// Every op of the language as a function; generated from the op table by `thalweg ops --header`, do not edit.
// A parameter out of its range throws std::invalid_argument with the error's text.
#pragma once

#include <array>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

#include "thalweg/shape.h"

namespace thalweg {

namespace builder {
inline constexpr int kOfOperands = 0;  ///< the dimension is that of the operands
[[nodiscard]] Shape made(std::string_view op, int dimension, std::span<const double> numbers,
                         std::vector<Shape> of = {}, int variant = 0);
[[nodiscard]] Shape made_formula(std::string_view op, std::string_view text, int dimension);
}  // namespace builder

/// circle: exact.
///   radius: distance from the centre to the edge
[[nodiscard]] inline Shape circle(double radius) {
  std::vector<double> numbers;
  numbers.push_back(radius);
  return builder::made("circle", 2, numbers);
}

/// box: exact.
///   half_size: half extents along x and y
[[nodiscard]] inline Shape box(Vec2 half_size) {
  std::vector<double> numbers;
  numbers.insert(numbers.end(), {half_size.x, half_size.y});
  return builder::made("box", 2, numbers);
}

/// rounded_box: exact.
///   half_size: half extents along x and y
///   radii: corner radii: top right, bottom right, top left, bottom left; at most min(half_size)
[[nodiscard]] inline Shape rounded_box(Vec2 half_size, std::array<double, 4> radii) {
  std::vector<double> numbers;
  numbers.insert(numbers.end(), {half_size.x, half_size.y});
  numbers.insert(numbers.end(), radii.begin(), radii.end());
  return builder::made("rounded_box", 2, numbers);
}

/// segment: exact, unsigned; has no inside: give it `round`.
///   a: one end
///   b: the other end
[[nodiscard]] inline Shape segment(Vec2 a, Vec2 b) {
  std::vector<double> numbers;
  numbers.insert(numbers.end(), {a.x, a.y});
  numbers.insert(numbers.end(), {b.x, b.y});
  return builder::made("segment", 2, numbers);
}

/// triangle: exact.
///   a: a corner
///   b: a corner
///   c: a corner; a, b, c must not lie on one line
[[nodiscard]] inline Shape triangle(Vec2 a, Vec2 b, Vec2 c) {
  std::vector<double> numbers;
  numbers.insert(numbers.end(), {a.x, a.y});
  numbers.insert(numbers.end(), {b.x, b.y});
  numbers.insert(numbers.end(), {c.x, c.y});
  return builder::made("triangle", 2, numbers);
}

/// polygon: exact; simple, either winding.
///   points: the corners in order; edges must not cross or touch
[[nodiscard]] inline Shape polygon(std::span<const Vec2> points) {
  std::vector<double> numbers;
  for (const Vec2& p : points) numbers.insert(numbers.end(), {p.x, p.y});
  return builder::made("polygon", 2, numbers);
}

/// half_plane: exact; f = normal . p - offset.
///   normal: points out of the half plane
///   offset: distance of the edge from the origin
[[nodiscard]] inline Shape half_plane(Vec2 normal, double offset) {
  std::vector<double> numbers;
  numbers.insert(numbers.end(), {normal.x, normal.y});
  numbers.push_back(offset);
  return builder::made("half_plane", 2, numbers);
}

/// sphere: exact.
///   radius: distance from the centre to the surface
[[nodiscard]] inline Shape sphere(double radius) {
  std::vector<double> numbers;
  numbers.push_back(radius);
  return builder::made("sphere", 3, numbers);
}

/// box: exact.
///   half_size: half extents along x, y and z
[[nodiscard]] inline Shape box(Vec3 half_size) {
  std::vector<double> numbers;
  numbers.insert(numbers.end(), {half_size.x, half_size.y, half_size.z});
  return builder::made("box", 3, numbers);
}

/// torus: exact; a bound inside where tube > radius; around the y axis.
///   radius: radius of the centre line
///   tube: radius of the tube
[[nodiscard]] inline Shape torus(double radius, double tube) {
  std::vector<double> numbers;
  numbers.push_back(radius);
  numbers.push_back(tube);
  return builder::made("torus", 3, numbers);
}

/// capsule: exact.
///   a: one end of the centre line
///   b: the other end
///   radius: radius
[[nodiscard]] inline Shape capsule(Vec3 a, Vec3 b, double radius) {
  std::vector<double> numbers;
  numbers.insert(numbers.end(), {a.x, a.y, a.z});
  numbers.insert(numbers.end(), {b.x, b.y, b.z});
  numbers.push_back(radius);
  return builder::made("capsule", 3, numbers);
}

/// cylinder: exact; along the y axis.
///   half_height: half of the height
///   radius: radius
[[nodiscard]] inline Shape cylinder(double half_height, double radius) {
  std::vector<double> numbers;
  numbers.push_back(half_height);
  numbers.push_back(radius);
  return builder::made("cylinder", 3, numbers);
}

/// plane: exact; f = normal . p - offset.
///   normal: points out of the half space
///   offset: distance of the plane from the origin
[[nodiscard]] inline Shape plane(Vec3 normal, double offset) {
  std::vector<double> numbers;
  numbers.insert(numbers.end(), {normal.x, normal.y, normal.z});
  numbers.push_back(offset);
  return builder::made("plane", 3, numbers);
}

/// star: exact; one tip points along +y; folded by reflections, no trigonometry.
///   radius: distance from the centre to a tip
///   points: number of tips
///   sharpness: 2: a regular polygon; `points`: spokes without area
[[nodiscard]] inline Shape star(double radius, double points, double sharpness) {
  std::vector<double> numbers;
  numbers.push_back(radius);
  numbers.push_back(points);
  numbers.push_back(sharpness);
  return builder::made("star", 2, numbers);
}

/// pie: exact; symmetric about +y.
///   aperture: half of the opening angle; pi: a disc
///   radius: radius
[[nodiscard]] inline Shape pie(double aperture, double radius) {
  std::vector<double> numbers;
  numbers.push_back(aperture);
  numbers.push_back(radius);
  return builder::made("pie", 2, numbers);
}

/// arc: exact; a bound inside where the stroke overlaps itself; symmetric about +y, round ends.
///   aperture: half of the opening angle; pi: a closed ring
///   radius: radius of the centre line
///   thickness: half of the stroke's width
[[nodiscard]] inline Shape arc(double aperture, double radius, double thickness) {
  std::vector<double> numbers;
  numbers.push_back(aperture);
  numbers.push_back(radius);
  numbers.push_back(thickness);
  return builder::made("arc", 2, numbers);
}

/// ring: exact; symmetric about +y, flat ends.
///   aperture: half of the opening angle; pi: closed
///   radius: radius of the centre line
///   thickness: full width, at most twice the radius
[[nodiscard]] inline Shape ring(double aperture, double radius, double thickness) {
  std::vector<double> numbers;
  numbers.push_back(aperture);
  numbers.push_back(radius);
  numbers.push_back(thickness);
  return builder::made("ring", 2, numbers);
}

/// moon: exact; disc ra minus disc rb.
///   offset: centre of the disc taken away, along +x
///   ra: radius of the disc that is kept
///   rb: radius of the disc taken away; below ra + offset
[[nodiscard]] inline Shape moon(double offset, double ra, double rb) {
  std::vector<double> numbers;
  numbers.push_back(offset);
  numbers.push_back(ra);
  numbers.push_back(rb);
  return builder::made("moon", 2, numbers);
}

/// cool_s: exact; height 2, width 0.8; its inner strokes are part of the surface.
[[nodiscard]] inline Shape cool_s() {
  std::vector<double> numbers;
  numbers.push_back(1);
  return builder::made("cool_s", 2, numbers);
}

/// union: exact outside; a bound inside.
[[nodiscard]] inline Shape union_(std::vector<Shape> of) {  // NOLINT(readability-identifier-naming): a keyword
  std::vector<double> numbers;
  return builder::made("union", builder::kOfOperands, numbers, std::move(of));
}

/// intersection: exact inside; a bound outside.
[[nodiscard]] inline Shape intersection(std::vector<Shape> of) {
  std::vector<double> numbers;
  return builder::made("intersection", builder::kOfOperands, numbers, std::move(of));
}

/// subtraction: exact inside; a bound outside; the first minus the rest.
[[nodiscard]] inline Shape subtraction(std::vector<Shape> of) {
  std::vector<double> numbers;
  return builder::made("subtraction", builder::kOfOperands, numbers, std::move(of));
}

/// smooth_union: a bound; k = 0: union.
///   k: how far the blend departs from the hard operator, at most
[[nodiscard]] inline Shape smooth_union(double k, std::vector<Shape> of) {
  std::vector<double> numbers;
  numbers.push_back(k);
  numbers.push_back(0);
  return builder::made("smooth_union", builder::kOfOperands, numbers, std::move(of));
}

/// smooth_intersection: a bound; k = 0: intersection.
///   k: how far the blend departs from the hard operator, at most
[[nodiscard]] inline Shape smooth_intersection(double k, std::vector<Shape> of) {
  std::vector<double> numbers;
  numbers.push_back(k);
  numbers.push_back(0);
  return builder::made("smooth_intersection", builder::kOfOperands, numbers, std::move(of));
}

/// smooth_subtraction: a bound; the first minus the rest; k = 0: subtraction.
///   k: how far the blend departs from the hard operator, at most
[[nodiscard]] inline Shape smooth_subtraction(double k, std::vector<Shape> of) {
  std::vector<double> numbers;
  numbers.push_back(k);
  numbers.push_back(0);
  return builder::made("smooth_subtraction", builder::kOfOperands, numbers, std::move(of));
}

/// round: exact outside of an exact field; inside too if convex; f - radius.
///   radius: how far the surface is moved out
[[nodiscard]] inline Shape round(const Shape& of, double radius) {
  std::vector<double> numbers;
  numbers.push_back(radius);
  return builder::made("round", builder::kOfOperands, numbers, {of});
}

/// onion: exact outside of an exact field; a bound inside; abs(f) - thickness.
///   thickness: half of the wall's width
[[nodiscard]] inline Shape onion(const Shape& of, double thickness) {
  std::vector<double> numbers;
  numbers.push_back(thickness);
  return builder::made("onion", builder::kOfOperands, numbers, {of});
}

/// translate: keeps its operand's.
///   by: displacement per axis
[[nodiscard]] inline Shape translate(const Shape& of, Vec2 by) {
  std::vector<double> numbers;
  numbers.insert(numbers.end(), {by.x, by.y});
  return builder::made("translate", builder::kOfOperands, numbers, {of});
}

/// translate: keeps its operand's.
///   by: displacement per axis
[[nodiscard]] inline Shape translate(const Shape& of, Vec3 by) {
  std::vector<double> numbers;
  numbers.insert(numbers.end(), {by.x, by.y, by.z});
  return builder::made("translate", builder::kOfOperands, numbers, {of});
}

/// rotate: keeps its operand's.
///   angle: counter-clockwise angle
[[nodiscard]] inline Shape rotate(const Shape& of, double angle) {
  std::vector<double> numbers;
  numbers.push_back(angle);
  return builder::made("rotate", builder::kOfOperands, numbers, {of});
}

/// rotate: keeps its operand's.
///   axis: axis of the rotation
///   angle: counter-clockwise angle
[[nodiscard]] inline Shape rotate(const Shape& of, Vec3 axis, double angle) {
  std::vector<double> numbers;
  numbers.insert(numbers.end(), {axis.x, axis.y, axis.z});
  numbers.push_back(angle);
  return builder::made("rotate", builder::kOfOperands, numbers, {of});
}

/// rotate: keeps its operand's; the same by quaternion.
///   quaternion: rotation as w, x, y, z; normalised on reading
[[nodiscard]] inline Shape rotate(const Shape& of, std::array<double, 4> quaternion) {
  std::vector<double> numbers;
  numbers.insert(numbers.end(), quaternion.begin(), quaternion.end());
  return builder::made("rotate", builder::kOfOperands, numbers, {of}, 1);
}

/// scale: keeps its operand's; uniform.
///   factor: how many times larger
[[nodiscard]] inline Shape scale(const Shape& of, double factor) {
  std::vector<double> numbers;
  numbers.push_back(factor);
  return builder::made("scale", builder::kOfOperands, numbers, {of});
}

/// rigid: keeps its operand's; rotate, then translate.
///   translate: displacement per axis
///   rotate: counter-clockwise angle
[[nodiscard]] inline Shape rigid(const Shape& of, Vec2 translate, double rotate) {
  std::vector<double> numbers;
  numbers.insert(numbers.end(), {translate.x, translate.y});
  numbers.push_back(rotate);
  return builder::made("rigid", builder::kOfOperands, numbers, {of});
}

/// rigid: keeps its operand's; rotate, then translate.
///   translate: displacement per axis
///   rotate: rotation as w, x, y, z; normalised on reading
[[nodiscard]] inline Shape rigid(const Shape& of, Vec3 translate, std::array<double, 4> rotate) {
  std::vector<double> numbers;
  numbers.insert(numbers.end(), {translate.x, translate.y, translate.z});
  numbers.insert(numbers.end(), rotate.begin(), rotate.end());
  return builder::made("rigid", builder::kOfOperands, numbers, {of});
}

/// mirror: keeps its operand's where that lies at positive coordinates.
///   axis: the axis that changes sign
[[nodiscard]] inline Shape mirror(const Shape& of, int axis) {
  std::vector<double> numbers;
  numbers.push_back(axis);
  return builder::made("mirror", builder::kOfOperands, numbers, {of});
}

/// expression: sign only; a formula over x, y, z, as in sqrt(x*x + y*y) - 1.
///   dimension: 2, 3, or 0: 3 if the formula depends on z, else 2
[[nodiscard]] inline Shape expression(std::string_view text, int dimension = 0) {
  return builder::made_formula("expression", text, dimension);
}

/// vm: sign only; a program in the text form of .vm files.
///   dimension: 2, 3, or 0: 3 if the formula depends on z, else 2
[[nodiscard]] inline Shape vm(std::string_view text, int dimension = 0) {
  return builder::made_formula("vm", text, dimension);
}

}  // namespace thalweg
