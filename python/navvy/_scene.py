# SPDX-License-Identifier: Apache-2.0
"""Scenes whose values are attributes, named as in the schema of scene files."""
from __future__ import annotations

import copy
import os
from typing import Any, Iterator, Mapping

from . import _navvy


def _text_of(value: Any) -> str:
    """Returns a value as a scene file writes it."""
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, str):
        return value
    try:
        return repr(float(value)) if not isinstance(value, int) else str(value)
    except TypeError:
        return " ".join(_text_of(one) for one in value)


class Node:
    """One element of a scene. Reading an attribute gives its value in the unit of its name; setting
    one checks it against the schema and the whole scene at once.
    """

    def __init__(self, scene: "Scene", path: str, place: tuple) -> None:
        object.__setattr__(self, "_scene", scene)
        object.__setattr__(self, "_path", path)
        object.__setattr__(self, "_place", place)

    def _values(self) -> dict:
        values = self._scene._tree
        for key in self._place:
            values = values[key]
        return values

    def __getattr__(self, name: str) -> Any:
        values = self._values()
        if values is None or name not in values:
            known = [] if values is None else sorted(values)
            raise AttributeError(
                "%s has no '%s'; it has: %s" % (self._path, name, ", ".join(known))
            )
        return self._scene._node(values[name], self._path + "." + name, self._place + (name,))

    def __setattr__(self, name: str, value: Any) -> None:
        self._scene._set(self._path + "." + name, value)

    def __dir__(self) -> list[str]:
        return sorted(self._values() or ())

    def __repr__(self) -> str:
        return "<%s: %s>" % (self._path, ", ".join(dir(self)))


class NodeList:
    """Elements that a scene may have several of, by name or index. An attribute set on the list is
    set on all of them; read, it is that of the only one.
    """

    def __init__(self, scene: "Scene", path: str, place: tuple) -> None:
        object.__setattr__(self, "_scene", scene)
        object.__setattr__(self, "_path", path)
        object.__setattr__(self, "_place", place)

    def _items(self) -> list:
        items = self._scene._tree
        for key in self._place:
            items = items[key]
        return items

    def names(self) -> list[str]:
        """Returns the names of the elements."""
        return [item["name"] for item in self._items()]

    def __len__(self) -> int:
        return len(self._items())

    def __iter__(self) -> Iterator[Node]:
        return (self[i] for i in range(len(self)))

    def __getitem__(self, key: str | int) -> Node:
        names = self.names()
        if isinstance(key, str):
            if key not in names:
                raise KeyError("the scene has no %s '%s'; it has: %s" % (self._path, key, names))
            index = names.index(key)
        else:
            index = range(len(names))[key]
        which = names[index] if names.count(names[index]) == 1 and names[index] else index + 1
        return Node(self._scene, "%s[%s]" % (self._path, which), self._place + (index,))

    def __getattr__(self, name: str) -> Any:
        if len(self) != 1:
            raise AttributeError(
                "the scene has %d elements %s (%s): choose one, as in %s[%r].%s"
                % (len(self), self._path, self.names(), self._path, (self.names() + ["?"])[0], name)
            )
        return getattr(self[0], name)

    def __setattr__(self, name: str, value: Any) -> None:
        self._scene._set(self._path + "." + name, value)

    def __repr__(self) -> str:
        return "<%s: %s>" % (self._path, self.names())


class Scene:
    """A scene file, or a shipped scene by its name, with changes.

    `scene.soil.cohesion_pa = 8000` changes all soils, `scene.soil["loam"].cohesion_pa` one of them;
    `scene.machine["digger"].pose = (1, 2, 0, 0, 0, 0.5)` moves a machine. `dir()` of an element
    lists what it has; `navvy.schema()` says what each value means. A value that the schema refuses
    raises InputError and changes nothing.
    """

    def __init__(self, file: str | os.PathLike, seed: int | None = None) -> None:
        object.__setattr__(self, "_file", os.fspath(file))
        object.__setattr__(self, "_seed", seed)
        object.__setattr__(self, "_settings", {})
        self._read(self._settings, seed)

    def _read(self, settings: dict[str, str], seed: int | None) -> None:
        data = _navvy.load_scene(self._file, list(settings.items()), seed)
        # Kept only if the scene is valid with them.
        object.__setattr__(self, "_data", data)
        object.__setattr__(self, "_tree", data.values())
        object.__setattr__(self, "_settings", settings)
        object.__setattr__(self, "_seed", seed)

    def _set(self, key: str, value: Any) -> None:
        self.update({key: value})

    def update(self, values: Mapping[str, Any]) -> None:
        """Sets several values at once, by their paths: `scene.update({"soil.cohesion_pa": 2000,
        "soil.residual_cohesion_pa": 500})`. They are checked together, so that values that bound
        each other need no order.
        """
        settings = dict(self._settings)
        for key, value in values.items():
            # The last setting counts, and it comes last.
            settings.pop(key, None)
            settings[key] = _text_of(value)
        self._read(settings, self._seed)

    def _node(self, value: Any, path: str, place: tuple) -> Any:
        if isinstance(value, dict):
            return Node(self, path, place)
        if isinstance(value, list):
            return NodeList(self, path, place)
        return value

    def __getattr__(self, name: str) -> Any:
        if name.startswith("_") or name not in self._tree:
            known = ", ".join(sorted(self.__dict__.get("_tree", ())))
            raise AttributeError("a scene has no '%s'; it has: %s" % (name, known))
        return self._node(self._tree[name], name, (name,))

    def __setattr__(self, name: str, value: Any) -> None:
        if name == "seed":
            self._read(self._settings, int(value))
        else:
            raise AttributeError("set a value of an element, such as scene.soil.cohesion_pa")

    def __dir__(self) -> list[str]:
        return sorted(self._tree)

    def copy(self) -> "Scene":
        """Returns a scene of its own with the same changes."""
        return copy.copy(self)

    def __copy__(self) -> "Scene":
        out = object.__new__(Scene)
        out.__dict__.update(self.__dict__)
        return out

    def __getstate__(self) -> tuple:
        return self._file, self._settings, self._seed

    def __setstate__(self, state: tuple) -> None:
        object.__setattr__(self, "_file", state[0])
        self._read(state[1], state[2])

    def __repr__(self) -> str:
        return "<navvy.Scene %r, changes %r>" % (self._data.name, self._settings)
