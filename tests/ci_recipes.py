#!/usr/bin/python3
"""The recipes of apps/ci, run as GitHub and GitLab run them, with stand-ins for apt-get and the upload: they
install the package, pass for equal grids, fail for others, and leave a report and a JUnit file.

Usage: ci_recipes.py VOX SOURCE
"""

import os
import re
import subprocess
import sys
import tempfile

try:
    import yaml
except ImportError:
    print("skipped: python3-yaml is not installed")
    sys.exit(77)

vox, source = map(os.path.abspath, sys.argv[1:])


def load(name):
    with open(os.path.join(source, "apps/ci", name), encoding="utf-8") as file:
        return yaml.safe_load(file)


def filled(text, values):
    """Expressions ${{ inputs.NAME }} and their like."""
    return re.sub(r"\$\{\{ *inputs\.(\w+) *\}\}", lambda found: values[found[1]], text)


def run(script, environment, shell=("bash", "--noprofile", "--norc", "-eo", "pipefail")):
    path = os.getcwd() + "/bin" + os.pathsep + os.environ["PATH"]
    return subprocess.run([*shell, "-c", script], env={**os.environ, "PATH": path, **environment},
                          capture_output=True, text=True)


def require_installed():
    with open("installed", encoding="utf-8") as file:
        lines = file.read().splitlines()
    assert lines[0].startswith("update") and lines[1].endswith(os.path.realpath("vox.deb")), lines
    os.remove("installed")


def require_report(folder, word):
    with open(f"{folder}/report.html", encoding="utf-8") as page:
        assert word in page.read()
    with open(f"{folder}/junit.xml", encoding="utf-8") as page:
        assert "<testsuite" in page.read()


def github(reference, result):
    """Exit code of the step."""
    action = load("action.yml")
    values = {name: entry.get("default") for name, entry in action["inputs"].items()}
    values.update(package="vox.deb", reference=reference, result=result)
    assert all(value is not None for value in values.values()), "an input without a value"
    code = 0
    uploaded = None
    for step in action["runs"]["steps"]:
        if "uses" in step:
            assert step["if"] == "always()" and step["uses"].startswith("actions/upload-artifact@")
            uploaded = filled(step["with"]["path"], values)
        elif code == 0 or step.get("if") == "always()":
            environment = {name: filled(text, values) for name, text in step["env"].items()}
            done = run(step["run"], {**environment, "GITHUB_STEP_SUMMARY": "summary"})
            code = code or done.returncode
            print(done.stdout[-300:], done.stderr[-300:])
    require_installed()
    assert os.path.isfile(f"{uploaded}/report.html") and os.path.isfile(f"{uploaded}/report.txt")
    with open("summary", encoding="utf-8") as summary:
        assert "2 files" in summary.read()
    os.remove("summary")
    return code, uploaded


def gitlab(reference, result):
    job = load("gitlab.yml")[".vox-diff"]
    values = {**job["variables"], "VOX_REFERENCE": reference, "VOX_RESULT": result}
    done = run("\n".join(job["before_script"] + job["script"]), values)
    print(done.stdout[-300:], done.stderr[-300:])
    require_installed()
    assert job["artifacts"]["when"] == "always"
    assert os.path.isfile(job["artifacts"]["reports"]["junit"])
    return done.returncode, job["artifacts"]["paths"][0]


with tempfile.TemporaryDirectory() as folder:
    os.chdir(folder)
    os.mkdir("bin")
    os.symlink(vox, "bin/vox")
    for name, text in (("apt-get", '#!/bin/sh\necho "$*" >>installed\n'), ("sudo", '#!/bin/sh\nexec "$@"\n')):
        with open("bin/" + name, "w", encoding="utf-8") as file:
            file.write(text)
        os.chmod("bin/" + name, 0o755)
    open("vox.deb", "w").close()
    jack = os.path.join(source, "scenes/toy_jack.obj")
    for name, dim in (("reference", "40"), ("same", "40"), ("other", "41")):
        os.mkdir(name)
        for model in ("jack 1.vdb", "jack 2.vdb"):
            subprocess.run([vox, "convert", jack, "-o", f"{name}/{model}", "--dim",
                            dim if model == "jack 2.vdb" else "40", "--quiet"], check=True)
    for recipe in (github, gitlab):
        code, report = recipe("reference", "same")
        assert code == 0, (recipe, code)
        require_report(report, "The same")
        code, report = recipe("reference", "other")
        assert code == 1, (recipe, code)
        require_report(report, "2 files: 1 differs, 1 same")
print("both recipes compare and keep a report")
