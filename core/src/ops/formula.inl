// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// Nodes whose field is a formula. Nothing is known of it beforehand: no distance, no Lipschitz constant, no bounds. Its
// sign is proven by intervals alone. The readers are in formula/, the ops that it is made of in scalar.inl and
// functions.inl.
// Included by all.inl once per SIMD target.

THALWEG_OP {
  static constexpr Declaration kDeclaration{.name = "expression",
                                            .kind = OpKind::formula,
                                            .exactness = "sign only",
                                            .note = "a formula over x, y, z, as in sqrt(x*x + y*y) - 1",
                                            .rounding = 0};
  static constexpr OpParameter kParameters[] = {
      {.name = "text", .quantity = Quantity::text, .meaning = "the formula", .choices = ""}};
};

THALWEG_OP {
  static constexpr Declaration kDeclaration{.name = "vm",
                                            .kind = OpKind::formula,
                                            .exactness = "sign only",
                                            .note = "a program in the text form of .vm files",
                                            .rounding = 0};
  static constexpr OpParameter kParameters[] = {
      {.name = "text",
       .quantity = Quantity::text,
       .meaning = "the program, one step a line",
       .choices = "",
       .optional = true},
      {.name = "file",
       .quantity = Quantity::text,
       .meaning = "in place of the text: a file that holds it, relative to the scene's",
       .choices = "",
       .optional = true}};
};
