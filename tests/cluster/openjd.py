#!/usr/bin/env python3
"""apps/cluster/openjd.yaml keeps the specification jobtemplate-2023-09 (the part of it that is used, with
no extensions), and its tasks, run in the order of the steps, make the file of the conversion as a
whole. Usage: openjd.py VOX SOURCE"""

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

EXPRESSION = re.compile(r"\{\{\s*([^{}]*?)\s*\}\}")
IDENTIFIER = re.compile(r"[A-Za-z_][A-Za-z0-9_]{0,63}\Z")


def keys(thing, required, optional=()):
    """An object of the specification has its keys and no others."""
    assert isinstance(thing, dict), thing
    missing, unknown = set(required) - set(thing), set(thing) - set(required) - set(optional)
    assert not missing and not unknown, (missing, unknown, thing)


def plain(text, most, least=1, lines=False):
    """A string without control characters, but those of lines."""
    assert isinstance(text, str) and least <= len(text) <= most, text
    assert all(c.isprintable() or lines and c in "\n\r\t" for c in text), text


def identifier(text):
    assert isinstance(text, str) and IDENTIFIER.match(text), text
    return text


def unique(things, name="name"):
    names = [thing[name] for thing in things]
    assert names and len(set(names)) == len(names), names
    return names


def format_string(text, known):
    """Every {{ }} of a format string names a value of its scope; no other brace is doubled."""
    assert isinstance(text, str)
    for name in EXPRESSION.findall(text):
        assert name in known, (name, sorted(known))
    rest = EXPRESSION.sub("", text)
    assert "{{" not in rest and "}}" not in rest, text


PARAMETER_KEYS = {
    "STRING": ("default", "allowedValues", "minLength", "maxLength", "userInterface"),
    "PATH": ("default", "allowedValues", "minLength", "maxLength", "objectType", "dataFlow", "userInterface"),
    "INT": ("default", "allowedValues", "minValue", "maxValue", "userInterface"),
}


def check_parameter(parameter):
    kind = parameter["type"]
    keys(parameter, ("name", "type"), ("description", *PARAMETER_KEYS[kind]))
    identifier(parameter["name"])
    if "description" in parameter:
        plain(parameter["description"], 2048, lines=True)
    if kind == "PATH":
        assert parameter.get("objectType", "DIRECTORY") in ("FILE", "DIRECTORY")
        assert parameter.get("dataFlow", "NONE") in ("NONE", "IN", "OUT", "INOUT")
    if kind == "INT":
        for key in ("default", "minValue", "maxValue"):
            assert isinstance(parameter.get(key, 0), int), parameter
        default = parameter.get("default", parameter.get("minValue", 0))
        assert parameter.get("minValue", default) <= default <= parameter.get("maxValue", default)
    elif "default" in parameter:
        plain(parameter["default"], 1024, least=parameter.get("minLength", 0))


def check_action(action, known):
    keys(action, ("command",), ("args", "timeout", "cancelation"))
    plain(action["command"], sys.maxsize)
    for text in [action["command"], *action.get("args", [])]:
        format_string(text, known)
        plain(text, sys.maxsize, least=0)
    if "cancelation" in action:
        cancelation = action["cancelation"]
        keys(cancelation, ("mode",), ("notifyPeriodInSeconds",))
        assert cancelation["mode"] in ("TERMINATE", "NOTIFY_THEN_TERMINATE")
        assert 1 <= cancelation.get("notifyPeriodInSeconds", 1) <= 600


def check_step(step, job_values, path_values):
    keys(step, ("name", "script"),
         ("description", "dependencies", "stepEnvironments", "hostRequirements", "parameterSpace"))
    plain(step["name"], 64)
    known = job_values | path_values | {"Session.WorkingDirectory"}
    if "parameterSpace" in step:
        keys(step["parameterSpace"], ("taskParameterDefinitions",), ("combination",))
        tasks = step["parameterSpace"]["taskParameterDefinitions"]
        assert len(tasks) <= 16
        for task in tasks:
            keys(task, ("name", "type", "range"))
            assert task["type"] == "INT", "other types are not used"
            format_string(task["range"], job_values)  # resolved when the job is made: no paths
        for name in unique(tasks):
            known |= {f"Task.Param.{identifier(name)}", f"Task.RawParam.{name}"}
    script = step["script"]
    keys(script, ("actions",), ("embeddedFiles",))
    files = script.get("embeddedFiles", [])
    for name in unique(files) if files else []:
        known.add(f"Task.File.{identifier(name)}")
    for file in files:
        keys(file, ("name", "type", "data"), ("filename", "runnable"))
        assert file["type"] == "TEXT" and file["data"]
        plain(file.get("filename", "x"), 64)
        assert "/" not in file.get("filename", "")
        format_string(file["data"], known)
    keys(script["actions"], ("onRun",))
    check_action(script["actions"]["onRun"], known)


def check_template(template):
    keys(template, ("specificationVersion", "name", "steps"),
         ("$schema", "description", "parameterDefinitions", "jobEnvironments"))
    assert template["specificationVersion"] == "jobtemplate-2023-09"
    plain(template["description"], 2048, lines=True)
    parameters = template["parameterDefinitions"]
    assert 1 <= len(parameters) <= 50
    unique(parameters)
    job_values, path_values = set(), set()
    for parameter in parameters:
        check_parameter(parameter)
        job_values.add(f"RawParam.{parameter['name']}")
        # Paths are mapped on the machine that runs a task.
        values = path_values if parameter["type"] == "PATH" else job_values
        values.add(f"Param.{parameter['name']}")
    format_string(template["name"], job_values)
    plain(template["name"], 128)
    names = unique(template["steps"])
    for step in template["steps"]:
        check_step(step, job_values, path_values)
        if "dependencies" in step:
            for name in unique(step["dependencies"], "dependsOn"):
                assert name in names and name != step["name"], name


def run(template, arguments, folder):
    """Runs all tasks of all steps, one after the other. Returns the number of tasks of each step."""
    values = {}
    for parameter in template["parameterDefinitions"]:
        value = str(arguments.get(parameter["name"], parameter.get("default")))
        values |= {f"Param.{parameter['name']}": value, f"RawParam.{parameter['name']}": value}

    def resolved(text, values):
        return EXPRESSION.sub(lambda match: values[match[1]], text)

    counts, done = {}, set()
    steps = list(template["steps"])
    while steps:
        step = next(s for s in steps if {d["dependsOn"] for d in s.get("dependencies", [])} <= done)
        steps.remove(step)
        tasks = [{}]
        if "parameterSpace" in step:
            (task,) = step["parameterSpace"]["taskParameterDefinitions"]
            first, last = map(int, resolved(task["range"], values).split("-"))
            tasks = [{f"Task.Param.{task['name']}": str(i)} for i in range(first, last + 1)]
        for task in tasks:
            names = values | task
            for file in step["script"].get("embeddedFiles", []):
                names[f"Task.File.{file['name']}"] = os.path.join(folder, file["filename"])
            for file in step["script"].get("embeddedFiles", []):
                with open(names[f"Task.File.{file['name']}"], "w", encoding="utf-8") as script:
                    script.write(resolved(file["data"], names))
            action = step["script"]["actions"]["onRun"]
            command = [resolved(text, names) for text in [action["command"], *action.get("args", [])]]
            subprocess.run(command, check=True, cwd=folder)
        counts[step["name"]] = len(tasks)
        done.add(step["name"])
    return counts


def main():
    vox, source = map(os.path.abspath, sys.argv[1:])
    with open(os.path.join(source, "apps/cluster/openjd.yaml"), encoding="utf-8") as file:
        template = yaml.safe_load(file)
    check_template(template)
    with tempfile.TemporaryDirectory() as folder:
        mesh = os.path.join(source, "scenes/toy_jack.obj")
        whole, output = os.path.join(folder, "whole.vdb"), os.path.join(folder, "the jack.vdb")
        options = "--dim 300 --grids density,mask"
        subprocess.run([vox, "convert", mesh, "-o", whole, *options.split()], check=True)
        arguments = {"Input": mesh, "Output": output, "Parts": 3, "Options": options, "Vox": vox}
        counts = run(template, arguments, folder)
        assert counts == {"Parts": 3, "Merge": 1}, counts
        with open(whole, "rb") as one, open(output, "rb") as other:
            assert one.read() == other.read(), "the merged file differs from the whole one"
    print("the template is valid; its tasks ran:", counts)


main()
