#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Help, version, and wrong usage: exit code 2 and one line that says what was meant."""
import json
import os
import unittest

import support

COMMANDS = ("info", "render", "compare", "bench", "draw", "bake", "scenes", "view")


class Help(support.CommandTest):
    def test_every_command_has_help_with_examples(self):
        for command in COMMANDS:
            text = self.succeed(command, "--help").stdout.decode()
            self.assertIn("Examples:", text)
            self.assertIn(f"catoptric {command}", text)
            self.assertIn("--json", text)
            self.assertEqual(text, self.succeed("help", command).stdout.decode())

    def test_program_help_lists_exactly_the_commands(self):
        text = self.succeed("--help").stdout.decode()
        for command in COMMANDS:
            self.assertRegex(text, rf"(?m)^  {command} +\S")
        self.assertIn("Examples:", text)

    def test_version_names_build_gl_and_embree(self):
        text = self.succeed("--version").stdout.decode()
        self.assertRegex(text, r"^catoptric \d+\.\d+\.\d+ \(commit [0-9a-f]{7,}|unknown, ")
        self.assertIn("OpenGL:", text)
        self.assertIn("Embree", text)

    def test_nothing_at_all_prints_help_on_stderr(self):
        done = self.run_command()
        self.assertEqual(done.returncode, 2)
        self.assertEqual(done.stdout, b"")
        self.assertIn(b"Usage: catoptric COMMAND", done.stderr)

    def test_no_escape_sequences_outside_of_a_terminal(self):
        done = self.succeed("info", "scene.gltf", env={"TERM": "xterm"})
        self.assertNotIn(b"\033", done.stdout + done.stderr)


class WrongUsage(support.CommandTest):
    def test_slips_get_a_suggestion(self):
        render = ("render", "scene.gltf", "-o", "x.png")
        self.refuse(2, ("unknown command 'rendr'", "did you mean 'render'?"), "rendr", "scene.gltf")
        self.refuse(2, ("--metod", "did you mean '--method'?"), *render, "--metod", "none")
        self.refuse(2, ("--metod", "did you mean '--method'?"), *render, "--metod=none")
        self.refuse(2, ("'-output'", "did you mean '--output'?"), "render", "scene.gltf", "-output", "x.png")
        self.refuse(2, ("'virtul'", "did you mean 'virtual'?"), *render, "--method", "virtul")
        self.refuse(2, ("'refind'", "did you mean 'refined'?"), *render, "--solver", "refind")
        self.refuse(2, ("'environmnt'", "did you mean 'environment'?"), "bench", "scene.gltf", "--methods", "environmnt")

    def test_options_of_another_method(self):
        for command in (("render", "scene.gltf", "-o", "x.png"), ("view", "scene.gltf")):
            self.refuse(2, ("--solver", "zexel"), *command, "--method", "zexel", "--solver", "exact")
            self.refuse(2, ("--baked", "--method morphing"), *command, "--baked", "x.bake")
            self.refuse(2, ("--merge", "raytrace"), *command, "--method", "raytrace", "--merge", "stencil")
            self.refuse(2, ("--texture-scale", "--merge texture"), *command, "--texture-scale", "0.5")
        self.refuse(2, ("nothing to merge", "+stencil"), "bench", "cylinder", "--methods", "raytrace+stencil")
        self.refuse(2, ("--texture-scale", "--merge texture"), "bench", "cylinder", "--texture-scale", "0.5")

    def test_a_backend_that_is_not_there(self):
        for command in (("render", "scene.gltf", "-o", "x.png"), ("view", "scene.gltf")):
            self.refuse(2, ("--backend", "'environment'"), *command, "--method", "environment", "--backend", "gpu")
            for solver in ("analytic", "subdivision", "exact"):
                self.refuse(2, (f"'{solver}' has no vertex shader", "layered"), *command, "--solver", solver, "--backend", "gpu")
            self.refuse(2, ("'gpus'", "did you mean 'gpu'?"), *command, "--backend", "gpus")
        self.refuse(2, ("'virtual-exact' has no vertex shader", "+gpu"), "bench", "cylinder", "--methods", "virtual-exact+gpu")
        self.refuse(2, ("--backend",), "bench", "cylinder", "--methods", "environment,raytrace", "--backend", "gpu")

    def test_values_that_are_no_good(self):
        for option, value in (("--size", "abc"), ("--size", "0x10"), ("--size", "-3x4"), ("--size", "10"),
                              ("--size", "99999x2"), ("--size", "16384x16384"), ("--size", "10x10x10"),
                              ("--bounces", "-1"), ("--bounces", "2.5"), ("--bounces", "99999999999"),
                              ("--samples", "0"), ("--max-error", "nan"), ("--max-error", "0"), ("--fov", "180"),
                              ("--eye", "1,2"), ("--eye", "1,2,x"), ("--eye", "1,2,inf"), ("--exposure", "-1"),
                              ("--max-memory", "lots"), ("--max-pixels", "-5"), ("--threads", "0"),
                              ("--reflector-metallic", "2"), ("--reflector-roughness", "rough")):
            self.refuse(2, (option, f"'{value}'"), "render", "scene.gltf", "-o", "x.png", f"{option}={value}")
        self.assertFalse(os.path.exists(self.path("x.png")))

    def test_missing_doubled_and_contradictory(self):
        picture = ("render", "scene.gltf", "-o", "x.png")
        self.refuse(2, "SCENE", "render", "-o", "x.png")
        self.refuse(2, "-o", "render", "scene.gltf")
        self.refuse(2, "-o", "compare", "scene.gltf")
        self.refuse(2, "--size", *picture, "--size")
        self.refuse(2, "more than once", *picture, "--size", "9x9", "--size", "8x8")
        self.refuse(2, "unexpected argument", *picture, "second.gltf")
        self.refuse(2, "no kind of picture", "render", "scene.gltf", "-o", "x.bmp")
        self.refuse(2, "no kind of picture", "render", "scene.gltf", "-o", "x")
        self.refuse(2, "--aov", *picture, "--aov", "x.png")
        self.refuse(2, "--camera excludes", *picture, "--camera", "0", "--eye", "1,2,3")
        self.refuse(2, "exclude", *picture, "--azimuth", "10", "--eye", "1,2,3")
        self.refuse(2, "need --eye", *picture, "--target", "1,2,3")
        self.refuse(2, "same point", *picture, "--eye", "1,2,3", "--target", "1,2,3")
        self.refuse(2, "exclude", *picture, "--quiet", "--verbose")
        self.refuse(2, "exclude", *picture, "--no-reflectors", "--reflector", "Mirror")
        self.refuse(2, "both", "render", "scene.gltf", "-o", "-", "--json", "-")
        self.refuse(2, "-o DIR", "scenes", "--all")
        self.refuse(2, "exclude", "scenes", "fender", "--all", "-o", "d")
        self.refuse(2, "named twice", "bench", "scene.gltf", "--methods", "none,none")
        self.refuse(2, "nothing to compare", "compare", "scene.gltf", "-o", "d", "--methods", "raytrace")
        self.refuse(2, "--limit-method", "compare", "scene.gltf", "-o", "d", "--methods", "none", "--limit-method",
                  "virtual-refined")
        self.refuse(2, "share", "compare", "scene.gltf", "-o", "d", "--min-within-1px", "120%")

    def test_errors_are_json_on_request(self):
        done = self.refuse(2, "--metod", "render", "scene.gltf", "--metod", "--json", "-")
        document = json.loads(done.stdout)
        self.assertEqual(document["schema"], 1)
        self.assertEqual(document["error"]["code"], "usage")
        self.assertIn("--method", document["error"]["hint"])
        self.assertEqual(set(document["error"]), {"code", "message", "pointer", "hint"})


if __name__ == "__main__":
    unittest.main()
