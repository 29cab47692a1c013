# SPDX-FileCopyrightText: The thalweg authors
# SPDX-License-Identifier: MIT
"""The structure checks find what they are for, and leave idiomatic code alone."""

import sys
import tempfile
import textwrap
import unittest
from pathlib import Path

sys.dont_write_bytecode = True
sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "tools" / "lint"))

import cpp_text  # noqa: E402
import layering  # noqa: E402
import links  # noqa: E402
import lists  # noqa: E402
import shape_of_files  # noqa: E402
import source_tree  # noqa: E402

HEADER = "// SPDX-FileCopyrightText: The thalweg authors\n// SPDX-License-Identifier: MIT\n"


def messages(findings: list[source_tree.Finding]) -> str:
    return "\n".join(map(str, findings))


class TreeTest(unittest.TestCase):
    def tree(self, files: dict[str, str]) -> list[source_tree.SourceFile]:
        """The files of a temporary folder with this content."""
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        for path, text in files.items():
            target = Path(folder.name) / path
            target.parent.mkdir(parents=True, exist_ok=True)
            target.write_text(text, encoding="utf-8")
        return source_tree.files(Path(folder.name))


class Layering(TreeTest):
    PUBLIC = {"core/include/thalweg/shape.h": "", "parallel/include/thalweg/batch.h": "", "core/src/solve/tile.h": ""}

    def fault(self, path: str, text: str) -> str:
        return messages(layering.check(self.tree({**self.PUBLIC, path: text})))

    def test_core_may_not_include_parallel(self):
        self.assertIn("belongs to parallel/include", self.fault("core/src/a.cpp", '#include "thalweg/batch.h"\n'))
        self.assertIn("leaves the room", self.fault("core/src/a.cpp", '#include "../../parallel/include/thalweg/batch.h"'))

    def test_parallel_and_tests_may_include_internals_of_core(self):
        self.assertEqual("", self.fault("parallel/src/a.cpp", '#include "solve/tile.h"\n'))
        self.assertEqual("", self.fault("tests/unit/a.cpp", '#include "solve/tile.h"\n'))

    def test_tools_and_public_headers_may_not(self):
        self.assertIn("core/src", self.fault("tools/thalweg/a.cpp", '#include "solve/tile.h"\n'))
        self.assertIn("core/src", self.fault("parallel/include/thalweg/b.h", '#include "solve/tile.h"\n'))

    def test_tbb_stays_in_two_source_files_of_parallel(self):
        include = "#include <tbb/parallel_for.h>\n"
        self.assertEqual("", self.fault("parallel/src/a.cpp", include))
        self.assertIn("belongs in a .cpp file", self.fault("parallel/src/a.h", include))
        self.assertIn("public header", self.fault("parallel/include/thalweg/b.h", include))
        self.assertIn("not for core/", self.fault("core/src/a.cpp", include))
        three = {f"parallel/src/{name}.cpp": include for name in "abc"}
        self.assertIn("more than 2 files", messages(layering.check(self.tree(three))))

    def test_core_has_no_thread_file_clock_or_environment(self):
        for header in ("thread", "fstream", "chrono", "mutex"):
            self.assertIn("core has no", self.fault("core/src/a.cpp", f"#include <{header}>\n"))
        self.assertIn("environment", self.fault("core/src/scene/a.cpp", 'auto v = std::getenv("X");\n'))
        self.assertEqual("", self.fault("core/src/kernels/targets.cpp", 'auto v = std::getenv("X");\n'))

    def test_libraries_do_not_print(self):
        self.assertIn("std::cerr", self.fault("parallel/src/a.cpp", "void f() { std::cerr << 1; }\n"))
        self.assertIn("never prints", self.fault("core/src/a.cpp", "void f() { std::exit(1); }\n"))
        self.assertEqual("", self.fault("core/src/a.cpp", '// std::cerr << 1\nconst char* s = "printf(";\n'))


class SourceLists(TreeTest):
    def faults(self, files: dict[str, str]) -> str:
        return messages(lists.check(self.tree(files)))

    def test_a_source_that_no_list_names_is_found(self):
        files = {"core/CMakeLists.txt": "add_library(core src/a.cpp)\n", "core/src/a.cpp": "", "core/src/aa.cpp": ""}
        self.assertEqual("core/CMakeLists.txt:1: src/aa.cpp is in no list of sources", self.faults(files))
        self.assertIn("no CMakeLists.txt", self.faults({"core/src/a.cpp": ""}))

    def test_a_test_program_lists_its_files_below_its_folder(self):
        files = {"tests/CMakeLists.txt": "program(\n  unit\n  shape/a_test.cpp)\n", "tests/unit/shape/a_test.cpp": ""}
        self.assertEqual("", self.faults(files))
        self.assertIn("unit/shape/b_test.cpp", self.faults({**files, "tests/unit/shape/b_test.cpp": ""}))


class FunctionLengths(TreeTest):
    def measured(self, code: str) -> dict[str, int]:
        return {body.name: body.lines for body in cpp_text.functions(textwrap.dedent(code))}

    def test_scopes_are_not_functions(self):
        code = """\
            namespace a::b {
            extern "C" {
            template <class T, template <class> class U>
            class alignas(64) Foo final : public Base<T> {
             public:
              explicit Foo(int a) : a_{a}, b_(a) {
                use(a);
              }
              int get() const noexcept { return a_; }
              auto operator()(int x) -> std::vector<int> {
                return {x};
              }

             private:
              int a_{1};
              enum class Kind : std::uint8_t { one, two };
            };
            }
            }  // namespace a::b
            """
        self.assertEqual({"Foo": 3, "get": 1, "operator": 3}, {k[:8]: v for k, v in self.measured(code).items()})

    def test_tables_are_not_functions_but_their_lambdas_are(self):
        code = """\
            constexpr Row kRows[] = {
                {"a", 1},
                {"b", 2, [](int x) {
                   return x;
                 }},
            };
            const auto twice = [](int x) {
              return 2 * x;
            };
            """
        self.assertEqual([3, 3], list(self.measured(code).values()))

    def test_macros_preprocessor_branches_and_literals_do_not_confuse_it(self):
        code = """\
            HWY_BEFORE_NAMESPACE();
            THALWEG_OP {
              static Facts facts(Numbers) {
                return {};
              }
            };
            THALWEG_LANE(abs, std::fabs(a.v))
            #define OPEN(x) \\
              {             \\
                x
            TEST(Lint, IsNotConfused) {
              const char* s = "}{" R"({{{)";
              char c = '{';  // {
              int n = 1'000;
            }
            #if A
            int f(int x) {
            #else
            int f(long x) {
            #endif
              return 1;
            }
            int g() { return 1; }
            """
        self.assertEqual({"facts": 3, "TEST": 5, "f": 4, "g": 1}, self.measured(code))

    def test_a_long_function_or_macro_is_found(self):
        body = "  work();\n" * 60
        long_function = HEADER + "void f() {\n" + body + "}\n"
        long_macro = HEADER + "#define M \\\n" + "  work(); \\\n" * 60 + "  work();\n"
        self.assertIn("f has 62 lines", messages(shape_of_files.check_sizes(self.tree({"core/src/a.cpp": long_function}))))
        self.assertIn("M has 62 lines", messages(shape_of_files.check_sizes(self.tree({"core/src/a.h": long_macro}))))


class Files(TreeTest):
    def test_the_header_is_demanded_after_a_hashbang_too(self):
        good = {"a.h": HEADER, "tool": "#!/bin/sh\n" + HEADER.replace("//", "#")}
        self.assertEqual("", messages(shape_of_files.check_headers(self.tree(good))))
        self.assertEqual(2, len(shape_of_files.check_headers(self.tree({"a.h": "// no header\n"}))))

    def test_long_files_and_paths_of_one_machine_are_found(self):
        self.assertIn("501 lines", messages(shape_of_files.check_sizes(self.tree({"a.cpp": "int a;\n" * 501}))))
        path = "/" + "home/someone/scene.json"
        self.assertEqual(1, len(shape_of_files.check_machine_paths(self.tree({"a.md": f"see {path}\n"}))))
        self.assertEqual([], shape_of_files.check_machine_paths(self.tree({"a.md": "see core/root/x, https://a.b/work/x\n"})))

    def test_links_must_resolve(self):
        page = "[a](b.md) [c](b.md#the-heading) [d](https://e.f) `[g](h)`\n"
        other = {"b.md": "# The heading\n"}
        self.assertEqual("", messages(links.check(self.tree({"a.md": page, **other}))))
        self.assertIn("leads nowhere", messages(links.check(self.tree({"a.md": "[a](gone.md)\n"}))))
        self.assertIn("no such heading", messages(links.check(self.tree({"a.md": "[a](b.md#gone)\n", **other}))))


if __name__ == "__main__":
    unittest.main()
