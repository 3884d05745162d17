"""The JSON schemas of src/io/schema against the program: what it writes fits them, keys are those that its readers know,
and what does not fit is refused by both.

  schemas.py PROGRAM PROJECT"""
import copy
import json
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import warnings

try:
    import jsonschema
except ImportError:
    print("python3-jsonschema is not installed")
    sys.exit(77)

program, project = sys.argv[1], pathlib.Path(sys.argv[2])
schemas = {path.name: json.loads(path.read_text()) for path in (project / "src/io/schema").glob("*.schema.json")}
failures = []


def check(condition, words):
    if not condition:
        failures.append(words)


def errors(name, document):
    """What a schema says against a document."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # the resolver is called old by later versions
        schema = schemas[name + ".schema.json"]
        resolver = jsonschema.RefResolver(base_uri="", referrer=schema, store=schemas)
        validator = jsonschema.Draft202012Validator(schema, resolver=resolver)
        return [f"{'/'.join(map(str, e.absolute_path))}: {e.message[:150]}" for e in validator.iter_errors(document)]


def fits(name, document, where):
    found = errors(name, document)
    check(not found, f"{where} does not fit {name}.schema.json: {found[:2]}")


def isostat(*words, cwd):
    return subprocess.run([program, *map(str, words)], cwd=cwd, capture_output=True, text=True)


def refused(document, folder):
    """The message of the program for a state or a certificate; None when it takes it."""
    file = folder / "altered.json"
    file.write_text(json.dumps(document))
    command = "verify" if document.get("format") == "isostat-certificate" else "inspect"
    done = isostat(command, file, cwd=folder)
    return done.stderr if done.returncode == 65 else None


def objects(document, path=()):
    """Every object of a document, with where it is; what is free ("provenance") left out."""
    if isinstance(document, dict):
        yield path, document
        for key, value in document.items():
            if key != "provenance":
                yield from objects(value, path + (key,))
    elif isinstance(document, list):
        for k, value in enumerate(document[:1]):
            yield from objects(value, path + (k,))


def at(document, path):
    for key in path:
        document = document[key]
    return document


def known_keys(message):
    found = re.search(r"expected one of ([a-z_0-9, ]+)", message or "")
    return set(found.group(1).strip().split(", ")) if found else set()


def keys_of(name, path):
    """Keys that a schema has for the object at a path."""
    schema = schemas[name + ".schema.json"]
    for key in path:
        schema = schema["properties"][key]
        for part in schema.get("allOf", []):
            schema = schemas[part["$ref"]] if "$ref" in part else schema
    return set(schema["properties"])


def try_alterations(name, document, folder):
    """Keys that are not there, left out, and of another kind."""
    fits(name, document, f"the {name} to alter")
    check(refused(document, folder) is None, f"the program refuses the {name} to alter")
    tried = 0
    for path, _ in objects(document):
        if name == "certificate" and ("low" in path or "high" in path):
            continue  # one of two forms
        altered = copy.deepcopy(document)
        at(altered, path)["colour"] = 1
        message = refused(altered, folder)
        check(errors(name, altered) and message is not None, f"{name}: an unknown key at {path} is taken")
        if message and "unknown field" in message:
            check(known_keys(message) == keys_of(name, path), f"{name} at {path}: the program knows {known_keys(message)}, the schema {keys_of(name, path)}")
            tried += 1
    for path, part in objects(document):
        for key in part:
            if key == "provenance":
                continue
            for value in ([], {"a": 1}, "word", True, 0.5):
                altered = copy.deepcopy(document)
                at(altered, path)[key] = value
                if errors(name, altered):  # the other way round numbers must agree with each other too
                    check(refused(altered, folder) is not None, f"{name}: the program takes {value} as {path + (key,)}")
            altered = copy.deepcopy(document)
            del at(altered, path)[key]
            if errors(name, altered):
                check(refused(altered, folder) is not None, f"{name}: the program needs no {path + (key,)}")
    return tried


def check_run(scene, folder, out):
    if named := re.search(r'file = "(/.*/)(.*)"', scene):  # a scene names files of its folder
        shutil.copy(named[1] + named[2], folder)
        scene = scene.replace(named[1], "")
    (folder / "scene.toml").write_text(scene)
    done = isostat("run", "scene.toml", "-o", out, "--quiet", "--force", cwd=folder)
    check(done.returncode in (0, 1, 2), f"{out}: {done.stderr}")
    run = folder / out
    seen = set()
    for path in sorted(run.rglob("*.json")):
        document = json.loads(path.read_text())
        kind = document["format"].removeprefix("isostat-")
        if kind + ".schema.json" in schemas:
            seen.add(kind)
            fits(kind, document, f"{out}: {path.name}")
    for name, schema in (("events.jsonl", "event"), ("certificates/arcs.jsonl", "witness")):
        if (run / name).exists():
            for line in (run / name).read_text().splitlines():
                seen.add(schema)
                fits(schema, json.loads(line), f"{out}: {name}")
                if schema == "event":
                    seen.update(json.loads(line).keys() & {"perturbed", "certificate", "held_at"})
    return seen


def check_inspections(states, folder):
    """What `inspect --json` prints of each state; keys that it prints, and how often."""
    seen = {}
    for path in states:
        document = json.loads(isostat("inspect", path, "--json", cwd=folder).stdout)
        fits("inspection", document, f"inspect {path.name}")
        for key in document:
            seen[key] = seen.get(key, 0) + 1
    altered = {**document, "colour": 1}
    check(errors("inspection", altered), "the inspection schema takes an unknown key")
    for key in [k for k, count in seen.items() if count == len(states)]:
        part = {k: v for k, v in document.items() if k != key}
        check(errors("inspection", part) or key not in schemas["inspection.schema.json"]["required"], f"the inspection schema needs no {key}")
    return set(seen)


def main():
    for path in [*project.glob("tests/data/**/*.json"), *project.glob("examples/**/*.json")]:
        document = json.loads(path.read_text())
        if isinstance(document, dict) and document.get("format") == "isostat-state":
            fits("state", document, path.name)
    with tempfile.TemporaryDirectory() as work:
        folder = pathlib.Path(work)
        programme = '\n[[programme]]\ndo = "up"\nequilibria = 2\n'
        box = "[packing]\ndisks = 40\ndiameters = [1.0, 2.0]\nseed = 3\n"
        seen = check_run(box + '[run]\ncertify = "arcs"\n' + programme, folder, "box")
        for name, way in (("cells/tilted-100", "up"), ("turns/three-disks", "down"), ("spheres/box-30", "up")):
            seen |= check_run(f'[packing]\nfile = "{project}/examples/{name}.json"\n' + programme.replace("up", way), folder, pathlib.Path(name).stem)
        for file in ("equal-pair", "two-forces", "two-gaps"):
            for name, cap in (("first", "max_choices = 0\n"), ("choose", "")):
                seen |= check_run(f'[packing]\nfile = "{project}/examples/ties/{file}.json"\n[run]\nties = "choose"\n{cap}' + programme, folder, file + name)
        states = [project / "tests/data/definition/01-overlap.json", *folder.glob("*/states/last.json")]
        states += [path for path in sorted((project / "examples").glob("*/*.json")) if json.loads(path.read_text()).get("format") == "isostat-state"]
        printed = check_inspections(states, folder)
        check({"cell", "disks", "spheres", "contact_stress", "left_at_zero"} <= printed, f"no state had all of {printed}")
        seen.add("inspection")

        wanted = {"inspection", "state", "certificate", "run", "summary", "event", "witness", "perturbed", "certificate", "held_at"}
        check(seen >= wanted, f"no run wrote {wanted - seen}")
        check(set(schemas) == {f"{s}.schema.json" for s in wanted - {"perturbed", "held_at"}}, f"schemas that no run was held to: {set(schemas)}")

        tried = 0
        for file in ("examples/cells/tilted-100.json", "tests/data/definition/09-no-dof.json"):
            tried += try_alterations("state", json.loads((project / file).read_text()), folder)
        perturbed = [json.loads(p.read_text()) for p in folder.glob("*first/states/last.json")]
        perturbed = [state for state in perturbed if "perturbation" in state]
        check(perturbed, "no state with a perturbation")
        tried += sum(try_alterations("state", state, folder) for state in perturbed[:1])
        certificate = json.loads(next((folder / "box/certificates").glob("eq_*.json")).read_text())
        tried += try_alterations("certificate", certificate, folder)
        check(tried >= 10, f"keys were compared for {tried} objects only")
    print(f"{len(failures)} failures" if failures else f"{len(schemas)} schemas, keys of {tried} objects compared")
    for words in failures[:20]:
        print(words)
    return 1 if failures else 0


sys.exit(main())
