// SPDX-FileCopyrightText: The thalweg authors
// SPDX-License-Identifier: MIT
//
// The `thalweg` program: its commands, in the order of --help.
#include <vector>

#include "command.h"
#include "output.h"

int main(int argc, char** argv) {
  using namespace thalweg::cli;
  remove_output_on_signals();
  std::vector<AddCommand> commands = {add_info,  add_ops,    add_eval,    add_collide, add_distance,
                                      add_sweep, add_render, add_profile, add_stress};
#ifdef THALWEG_HAS_DEMO
  commands.push_back(add_demo);
#endif
  return run(argc, argv, commands);
}
