"""Writes a scene as TOML: the standard library only reads it."""

import json
import re

BARE = re.compile(r"[A-Za-z0-9_-]+")


def toml_text(scene):
    """Plain values first, then [table]s and [[array]]s of tables; what lies deeper stands in one line."""
    plain, tables = [], []
    for key, value in scene.items():
        if isinstance(value, dict):
            tables += [f"\n[{_key(key)}]", *_lines(value)]
        elif isinstance(value, list) and value and all(isinstance(item, dict) for item in value):
            for item in value:
                tables += [f"\n[[{_key(key)}]]", *_lines(item)]
        else:
            plain.append(f"{_key(key)} = {value_text(value)}")
    return "\n".join(plain + tables) + "\n"


def _lines(table):
    return [f"{_key(key)} = {value_text(value)}" for key, value in table.items()]


def _key(key):
    return key if BARE.fullmatch(key) else _string(key)


def _string(text):
    # JSON's escapes are TOML's; only DEL passes JSON unescaped.
    return json.dumps(text, ensure_ascii=False).replace("\x7f", "\\u007f")


def value_text(value):
    """A value in one line."""
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, (int, float)):
        return repr(value)
    if isinstance(value, str):
        return _string(value)
    if isinstance(value, list):
        return "[" + ", ".join(map(value_text, value)) + "]"
    if isinstance(value, dict):
        return "{ " + ", ".join(f"{_key(key)} = {value_text(item)}" for key, item in value.items()) + " }"
    raise TypeError(f"scenes hold no {type(value).__name__}")
