"""The object dictionary against the Python package `canopen`, which masters of CANopen are written with.

`canopen` reads the electronic data sheet (CiA 306). Then
- every object of its reading is one of the table, which is read as JSON, with the same name, type, access, default and range;
- a slave that `canopen` makes of the data sheet and the drive give the same bytes or the same abort code for every read of
  every index around the areas of the drive, and for writes of every entry: what it holds, one byte more and one less;
- the ends of every range that `canopen` read are taken, what is beyond is refused as too high or too low;
- `canopen` finds the process data objects in the data sheet by itself, and reads the values in a frame by their names;
- a slave that `canopen` makes of the data sheet serves a master of `canopen` by SDO, its strings too, and its emergency messages
  reach that master: the objects of CiA 301 that they need are there.
"""

import json
import logging
import subprocess
import tempfile
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any

import canopen
from canopen.objectdictionary import ODArray, ODVariable, datatypes

ROOT = Path(__file__).resolve().parents[2]
PDO_AREAS = (range(0x1400, 0x1408), range(0x1600, 0x1608), range(0x1800, 0x1808), range(0x1A00, 0x1A08))
AREAS = (range(0x1000, 0x1020), range(0x1200, 0x1202), *PDO_AREAS, range(0x2000, 0x2020), range(0x6030, 0x6120), range(0x64F0, 0x6510))
SUBINDICES = range(0, 6)
TYPES = {
    "INTEGER8": datatypes.INTEGER8,
    "INTEGER16": datatypes.INTEGER16,
    "INTEGER32": datatypes.INTEGER32,
    "UNSIGNED8": datatypes.UNSIGNED8,
    "UNSIGNED16": datatypes.UNSIGNED16,
    "UNSIGNED32": datatypes.UNSIGNED32,
    "UNSIGNED64": datatypes.UNSIGNED64,
    "VISIBLE_STRING": datatypes.VISIBLE_STRING,
}
# What CiA 402 maps by default: identifier of node 1, and the objects by name.
PROCESS_DATA = {
    "RPDO": [
        (0x201, ["Controlword"]),
        (0x301, ["Controlword", "Modes of operation"]),
        (0x401, ["Controlword", "Target position"]),
        (0x501, ["Controlword", "Target velocity"]),
    ],
    "TPDO": [
        (0x181, ["Statusword"]),
        (0x281, ["Statusword", "Modes of operation display"]),
        (0x381, ["Statusword", "Position actual value"]),
        (0x481, ["Statusword", "Velocity actual value"]),
    ],
}
TOO_HIGH, TOO_LOW = "06090031", "06090032"

# A line of a request to the drive: read or write, index, sub-index, bytes.
Access = tuple[str, int, int, bytes]


def example(*arguments: str, text: str | None = None) -> str:
    """What the example `object_dictionary` prints."""
    command = ["cargo", "run", "--quiet", "--release", "--package", "servobench-cia402", "--example", "object_dictionary"]
    command += ["--", *arguments]
    return subprocess.run(command, cwd=ROOT, input=text, stdout=subprocess.PIPE, text=True, check=True).stdout


def read_data_sheet() -> canopen.ObjectDictionary:
    """The data sheet as `canopen` reads it, which only warns of some mistakes."""
    warnings: list[logging.LogRecord] = []
    handler = logging.Handler()
    handler.emit = warnings.append  # type: ignore[method-assign]
    logging.getLogger("canopen").addHandler(handler)
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "drive.eds"
        path.write_text(example("eds", path.name, "11-21-2026", "08:00AM"), encoding="utf-8")
        dictionary = canopen.import_od(str(path), node_id=1)
    if warnings:
        raise SystemExit(f"canopen warns of the data sheet: {[record.getMessage() for record in warnings]}")
    return dictionary


def variables(dictionary: canopen.ObjectDictionary) -> Iterator[ODVariable]:
    """Every entry with a value, sub-indices 00h of arrays and records too."""
    for entry in dictionary.values():
        if isinstance(entry, ODVariable):
            yield entry
        else:
            yield from entry.values()


def compare_tables(dictionary: canopen.ObjectDictionary, table: Sequence[dict[str, Any]]) -> list[str]:
    """Differences between the reading of `canopen` and the table."""
    expected = {(entry["index"], entry["subindex"]): entry for entry in table}
    wrong = []
    for entry in variables(dictionary):
        key = f"{entry.index:04X}h:{entry.subindex:02X}h"
        known = expected.pop((entry.index, entry.subindex), None)
        if known is None:
            highest = sum(other["index"] == entry.index for other in table)
            if (entry.subindex, entry.default, entry.data_type) != (0, highest, datatypes.UNSIGNED8):
                wrong.append(f"{key} is not in the table")
            continue
        # In a data sheet the direction of process data belongs to the access.
        access = {"RPDO": "rww", "TPDO": "rwr"}.get(known["pdo"]) if known["access"] == "rw" else None
        lowest, highest = known.get("range", (None, None))
        object_name = dictionary[entry.index].name
        pairs = {
            "object": (object_name, known["object"]),
            "type": (entry.data_type, TYPES[known["type"]]),
            "access": (entry.access_type, access or known["access"]),
            "PDO": (entry.pdo_mappable, known["pdo"] != ""),
            "default": (entry.default, known["default"]),
            "range": ((entry.min, entry.max), (lowest, highest)),
        }
        wrong += [f"{key}: {what} read as {read}, in the table {is_}" for what, (read, is_) in pairs.items() if read != is_]
        if not entry.name.startswith(known["name"]):
            wrong.append(f"{key} is named {entry.name}, in the table {known['name']}")
    wrong += [f"{index:04X}h:{subindex:02X}h is not in the data sheet" for index, subindex in expected]
    return wrong


def ask(accesses: Sequence[Access]) -> list[str]:
    """The drive's answers: bytes in hexadecimal digits, or an abort code after `abort`."""
    lines = (f"{verb} {index:04x} {subindex:02x} {data.hex()}\n" for verb, index, subindex, data in accesses)
    answers = example("sdo", text="".join(lines)).splitlines()
    if len(answers) != len(accesses):
        raise SystemExit(f"{len(accesses)} accesses, {len(answers)} answers")
    return [" ".join(answer.split()[:2]) for answer in answers]


def slave_answer(slave: canopen.LocalNode, access: Access) -> str:
    """What the slave of `canopen` answers, in the words of the drive."""
    verb, index, subindex, data = access
    try:
        if verb == "read":
            return slave.get_data(index, subindex, check_readable=True).hex()
        slave.set_data(index, subindex, data, check_writable=True)
    except canopen.SdoAbortedError as aborted:
        return f"abort {aborted.code:08x}"
    return ""


def accesses(dictionary: canopen.ObjectDictionary) -> Iterator[Access]:
    """Reads of everything there may be, and writes of every entry in its own and in wrong lengths."""
    for index in (index for area in AREAS for index in area):
        for subindex in SUBINDICES:
            # Of variables and arrays, `canopen` has every sub-index.
            entry = dictionary.get(index)
            if isinstance(entry, ODVariable) and subindex > 0:
                continue
            if isinstance(entry, ODArray) and subindex > entry[0].default:
                continue
            yield "read", index, subindex, b""
    for entry in variables(dictionary):
        data = entry.encode_raw(entry.default)
        for written in (data, data + b"\0", data[:-1]):
            yield "write", entry.index, entry.subindex, written
        yield "read", entry.index, entry.subindex, b""


def compare_accesses(dictionary: canopen.ObjectDictionary, asked: Sequence[Access]) -> list[str]:
    """Accesses that the drive and the slave of `canopen` answer differently."""
    slave = canopen.LocalNode(1, dictionary)
    wrong = []
    for access, ours in zip(asked, ask(asked), strict=True):
        theirs = slave_answer(slave, access)
        if ours != theirs:
            verb, index, subindex, data = access
            wrong.append(f"{verb} {index:04X}h:{subindex:02X}h {data.hex()}: `{ours}`, canopen `{theirs}`")
    return wrong


def range_ends(dictionary: canopen.ObjectDictionary) -> list[tuple[Access, str]]:
    """Writes at and beyond the ends of every range, as far as the type goes, and how each has to be answered."""
    ends = []
    for entry in variables(dictionary):
        if entry.min is None or not entry.writable:
            continue
        steps = ((entry.max, ""), (entry.min, ""), (entry.max + 1, f"abort {TOO_HIGH}"), (entry.min - 1, f"abort {TOO_LOW}"))
        signed = entry.data_type in datatypes.SIGNED_TYPES
        size = len(entry) // 8
        for value, answer in steps:
            try:
                data = value.to_bytes(size, "little", signed=signed)
            except OverflowError:
                continue
            ends.append((("write", entry.index, entry.subindex, data), answer))
    return ends


def process_data(dictionary: canopen.ObjectDictionary) -> list[str]:
    """What a master of `canopen` makes of the process data objects differently than CiA 402 has it."""
    network = canopen.Network()
    node = network.add_node(1, dictionary)
    wrong = []
    for kind, expected in PROCESS_DATA.items():
        maps = node.rpdo if kind == "RPDO" else node.tpdo
        maps.read(from_od=True)
        found = [(pdo.cob_id, [variable.name for variable in pdo]) for pdo in maps.values() if pdo.enabled]
        if found != expected:
            wrong.append(f"{kind}s read as {found}")
    # In Operation enabled at -1000000 units: little-endian, the statusword first.
    network.notify(0x381, bytearray.fromhex("3702c0bdf0ff"), 0.0)
    read = [variable.raw for variable in node.tpdo[3]]
    if read != [0x0237, -1_000_000]:
        wrong.append(f"a frame of TPDO 3 read as {read}")
    return wrong


class Wire(canopen.Network):
    """A network whose frames reach another one at once."""

    def __init__(self) -> None:
        super().__init__()
        self.other: canopen.Network | None = None

    def send_message(self, can_id: int, data: bytes, remote: bool = False) -> None:
        """Hands the frame to the other network."""
        assert self.other is not None
        self.other.notify(can_id, bytearray(data), 0.0)


def conversation(dictionary: canopen.ObjectDictionary, table: Sequence[dict[str, Any]]) -> list[str]:
    """What a master and a slave of `canopen` do not get through to each other."""
    ours, theirs = Wire(), Wire()
    ours.other, theirs.other = theirs, ours
    slave, master = canopen.LocalNode(1, dictionary), canopen.RemoteNode(1, dictionary)
    theirs.add_node(slave)
    ours.add_node(master)
    wrong = []
    for entry in table:
        index, subindex, access = entry["index"], entry["subindex"], entry["access"]
        if access == "wo":
            continue
        variable = dictionary[index] if isinstance(dictionary[index], ODVariable) else dictionary[index][subindex]
        value = variable.decode_raw(master.sdo.upload(index, subindex))
        if value != entry["default"]:
            wrong.append(f"{index:04X}h:{subindex:02X}h read over the bus is {value}, in the table {entry['default']}")
    master.sdo[0x6065].raw = 2000
    if slave.sdo[0x6065].raw != 2000:
        wrong.append("a following error window written over the bus does not arrive")
    slave.emcy.send(0x8611, 0x20)
    if [error.code for error in master.emcy.log] != [0x8611]:
        wrong.append(f"emergency messages {master.emcy.log}")
    # The heartbeat itself needs a CAN interface; its time is where the slave looks for it.
    if slave.sdo[0x1017].raw != 0:
        wrong.append("the producer heartbeat time is not 0")
    return wrong


def main() -> None:
    """Compares the tables, the accesses, the ranges and the process data objects."""
    dictionary, table = read_data_sheet(), json.loads(example("json"))
    wrong = compare_tables(dictionary, table)
    print(f"object dictionary: {len(dictionary)} objects with {len(table)} values, as canopen {canopen.__version__} reads them")
    asked = list(accesses(dictionary))
    wrong += compare_accesses(dictionary, asked)
    print(f"{len(asked)} accesses answered by the drive and by a slave of canopen")
    ends = range_ends(dictionary)
    answers = ask([access for access, _ in ends])
    wrong += [f"{access} is answered by `{is_}`, not `{due}`" for (access, due), is_ in zip(ends, answers, strict=True) if is_ != due]
    print(f"{len(ends)} writes at and beyond the ends of ranges")
    wrong += conversation(dictionary, table)
    print("a slave of canopen made of the data sheet serves a master of canopen")
    wrong += process_data(dictionary)
    print(f"{sum(map(len, PROCESS_DATA.values()))} process data objects found by canopen")
    if wrong:
        raise SystemExit(f"{len(wrong)} differences, the first: " + "; ".join(wrong[:5]))


if __name__ == "__main__":
    main()
