"""Edits of examples, as a user makes them: each one fails where it changes nothing."""
import csv
import pathlib


class Folder:
    def __init__(self, path):
        self.path = pathlib.Path(path)

    def replace(self, file, old, new):
        """The only occurrence of a text."""
        text = (self.path / file).read_text()
        if text.count(old) != 1:
            raise ValueError(f"{file}: {text.count(old)} times {old!r}")
        self.write(file, text.replace(old, new))

    def replace_all(self, file, old, new):
        text = (self.path / file).read_text()
        if old not in text:
            raise ValueError(f"{file}: no {old!r}")
        self.write(file, text.replace(old, new))

    def write(self, file, text):
        (self.path / file).write_text(text)

    def remove(self, file):
        (self.path / file).unlink()

    def logs(self):
        """The starter's runs."""
        return sorted(file.name for file in self.path.glob("run_*.csv"))

    def each_log(self, change):
        """Text of each run after a change."""
        for name in self.logs():
            self.write(name, change((self.path / name).read_text()))

    def columns(self, change):
        """Each run after a change of its columns, a dictionary of lists of numbers."""
        for name in self.logs():
            rows = list(csv.reader((self.path / name).open()))
            values = {key: [float(row[at]) for row in rows[1:]] for at, key in enumerate(rows[0])}
            change(values)
            lines = [",".join(values), *(",".join(map(repr, row)) for row in zip(*values.values()))]
            self.write(name, "\n".join(lines) + "\n")
