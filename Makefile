# SPDX-License-Identifier: Apache-2.0
# Thin: scripts/ and the CMake presets do the work. Two commands do all set-up: `make demo` and `make test`.
.DEFAULT_GOAL := help
.PHONY: help demo test build setup setup-checks format check sanitize bench figures readme-figures package clean

help: ## say what can be made
	@sed -n 's/^\([a-z-]*\):.*## /  make \1|/p' $(MAKEFILE_LIST) | while IFS='|' read -r name what; do \
	  printf '%-24s %s\n' "$$name" "$$what"; done

setup:
	@scripts/install_packages.sh

setup-checks:
	@scripts/install_packages.sh --with-checks

demo: setup ## set up, build, render the built-in scenes with every method and compare them with ray-traced truth
	@scripts/build.sh release catoptric_app
	@scripts/demo.sh

test: setup ## set up, build and run the whole test suite
	@scripts/build.sh release
	@scripts/test.sh

build: setup ## set up and build everything; the command is build/release/catoptric
	@scripts/build.sh release

format: setup-checks ## format all C++ files
	@scripts/check_format.sh --fix

check: setup-checks ## format, sources, shaders, clang-tidy (TIDY_SECONDS=N bounds the last)
	@scripts/check.sh

sanitize: setup ## build the tests with the address and undefined-behaviour sanitizers and run them
	@scripts/sanitize.sh

bench: setup ## run the benchmarks of the hot paths
	@scripts/build.sh release
	@scripts/bench.sh

figures: setup ## make every figure of the papers again, beside the truth, into docs/figures
	@scripts/build.sh release catoptric_app
	@python3 -B scripts/figures build/release/catoptric docs/figures

readme-figures: demo ## put pictures and figures of reports of `catoptric compare` into README.md
	@python3 -B scripts/readme_pictures.py build/release/catoptric
	@python3 scripts/readme_table.py --update README.md out/demo/report.json out/demo/*/report.json

package: setup-checks ## make the Debian packages in build/release
	@scripts/build.sh release
	@cd build/release && cpack -G DEB

clean: ## remove everything that was built or rendered
	rm -rf build out
