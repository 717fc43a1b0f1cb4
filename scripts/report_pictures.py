# SPDX-License-Identifier: Apache-2.0
"""The report that `catoptric compare` leaves in a folder, read back: its figures, and the pictures that its page carries in
itself (JPEG). Both the README's strip and `make figures` take them from there, so what they show is what compare measured."""
import base64
import json
import os
import re

DATA_BLOCK = re.compile(r'<script type="application/json" id="report">(.*?)</script>', re.S)


def read_rows(folder):
    """The rows of report.json, as they are."""
    with open(os.path.join(folder, "report.json"), encoding="utf-8") as file:
        return json.load(file)["results"]


def read_pictures(folder):
    """Name of a picture's file -> bytes of the JPEG in index.html."""
    with open(os.path.join(folder, "index.html"), encoding="utf-8") as file:
        block = DATA_BLOCK.search(file.read())
    if block is None:
        raise SystemExit(f"{folder}/index.html: no data block; made by another version of compare?")
    pictures = json.loads(block.group(1).replace("<\\/", "</"))["pictures"]
    return {name: base64.b64decode(address.split(",", 1)[1]) for name, address in pictures.items()}
