"""Holds decks against the JSON schema: validate_decks.py SCHEMA DECK... prints `good PATH` or `bad PATH: why`.

Exit code 3 where a package is missing.
"""

import json
import re
import sys

try:
    import jsonschema
    import yaml
except ImportError as missing:
    print(missing)
    sys.exit(3)


class Loader(yaml.SafeLoader):
    """Numbers as in YAML 1.2: 30e6 is one."""


Loader.yaml_implicit_resolvers = {
    first: [(tag, expression) for tag, expression in resolvers if tag != "tag:yaml.org,2002:float"]
    for first, resolvers in yaml.SafeLoader.yaml_implicit_resolvers.items()
}
Loader.add_implicit_resolver(
    "tag:yaml.org,2002:float",
    re.compile(r"^[-+]?(\.[0-9]+|[0-9]+(\.[0-9]*)?)([eE][-+]?[0-9]+)?$|^[-+]?\.(inf|Inf|INF)$|^\.(nan|NaN|NAN)$"),
    list("-+.0123456789"),
)

with open(sys.argv[1], encoding="utf-8") as file:
    schema = json.load(file)
jsonschema.Draft7Validator.check_schema(schema)
validator = jsonschema.Draft7Validator(schema)
for path in sys.argv[2:]:
    try:
        with open(path, encoding="utf-8") as file:
            deck = yaml.load(file, Loader)
        error = next(iter(validator.iter_errors(deck)), None)
        print(f"good {path}" if error is None else f"bad {path}: {error.message}")
    except (yaml.YAMLError, UnicodeError) as error:
        print(f"bad {path}: {str(error).splitlines()[0]}")
