"""The wire form: what goes in comes out, and nothing foreign, damaged or absurd comes through or raises."""

import zlib
from math import inf, nan

import msgspec
import pytest
from hypothesis import given
from hypothesis import strategies as st
from msgspec import inspect

from protocol.codec import KINDS, MAX_FRAME, SCHEMA_VERSION, Codec, Refusal
from protocol.messages import Answer, Drive, Field, Message, Outcome, Reading, Shared

TOKEN = 0x0123456789ABCDEF
MAX_RECORDS = 4096  # of one tuple in a message between members
CODEC = Codec(TOKEN)


def values_of(kind: inspect.Type) -> st.SearchStrategy:
    """Values of a field's type, straight from the annotation."""
    match kind:
        case inspect.BoolType():
            return st.booleans()
        case inspect.IntType():
            return st.integers(-(2**63), 2**63 - 1)
        case inspect.FloatType(ge=least, le=most):
            assert (least, most) == (-1e12, 1e12), "every float on the wire has bounds"
            return st.floats(least, most)
        case inspect.StrType():
            return st.text(max_size=40)
        case inspect.BytesType():
            return st.binary(max_size=80)
        case inspect.NoneType():
            return st.none()
        case inspect.VarTupleType(item_type=item):
            return st.lists(values_of(item), max_size=4).map(tuple)
        case inspect.TupleType(item_types=items):
            return st.tuples(*(values_of(item) for item in items))
        case inspect.DictType(key_type=key, value_type=value):
            return st.dictionaries(values_of(key), values_of(value), max_size=4)
        case inspect.UnionType(types=types):
            return st.one_of(*(values_of(t) for t in types))
    raise AssertionError(f"no strategy for {kind}")


def messages_of(cls: type[Message]) -> st.SearchStrategy[Message]:
    info = inspect.type_info(cls)
    return st.builds(cls, *(values_of(field.type) for field in info.fields))


MESSAGES = st.one_of(*(messages_of(cls) for cls in KINDS))
READING = Reading(1, 2, 0.1, *[1.5] * 8, hears=((0, 1), (2, 2)))


def framed(kind: int, body: bytes, token: int = TOKEN) -> bytes:
    """A frame as the module's docstring describes it, check sum and all."""
    prefix = b"Os" + bytes((SCHEMA_VERSION, kind))
    check = zlib.crc32(prefix + token.to_bytes(8, "little") + body)
    return prefix + check.to_bytes(4, "little") + body


@pytest.mark.parametrize("cls", KINDS, ids=lambda cls: cls.__name__)
def test_every_kind_of_message_survives_the_wire(cls: type[Message]) -> None:
    @given(messages_of(cls))
    def check(message: Message) -> None:
        frame = CODEC.encode(message)
        again = CODEC.decode(frame)
        assert type(again) is cls
        assert again == message
        assert frame == framed(KINDS.index(cls), msgspec.msgpack.encode(message))

    check()


@given(MESSAGES, st.data())
def test_no_part_of_a_frame_is_taken_for_a_frame(message: Message, data: st.DataObject) -> None:
    frame = CODEC.encode(message)
    cut = data.draw(st.integers(0, len(frame) - 1))
    assert isinstance(CODEC.decode(frame[:cut]), Refusal)


@given(MESSAGES, st.data())
def test_a_frame_with_flipped_bits_is_refused(message: Message, data: st.DataObject) -> None:
    frame = bytearray(CODEC.encode(message))
    for bit in data.draw(st.sets(st.integers(0, 8 * len(frame) - 1), min_size=1, max_size=3)):
        frame[bit // 8] ^= 1 << bit % 8
    assert isinstance(CODEC.decode(bytes(frame)), Refusal)


@given(MESSAGES, st.binary(min_size=1, max_size=8), st.data())
def test_a_frame_with_bytes_put_in_is_refused(message: Message, more: bytes, data: st.DataObject) -> None:
    frame = CODEC.encode(message)
    at = data.draw(st.integers(0, len(frame)))
    assert isinstance(CODEC.decode(frame[:at] + more + frame[at:]), Refusal)


@given(st.binary(max_size=200))
def test_foreign_bytes_are_refused(noise: bytes) -> None:
    assert isinstance(CODEC.decode(noise), Refusal)


@given(st.integers(0, len(KINDS) - 1), st.binary(min_size=1, max_size=200))
def test_a_sound_frame_around_any_body_is_decoded_or_refused_and_never_raises(kind: int, body: bytes) -> None:
    taken = CODEC.decode(framed(kind, body))
    assert isinstance(taken, (Refusal, KINDS[kind]))


@given(MESSAGES, st.integers(0, 2**64 - 1).filter(lambda token: token != TOKEN))
def test_a_frame_of_another_run_is_refused(message: Message, token: int) -> None:
    assert isinstance(CODEC.decode(Codec(token).encode(message)), Refusal)


@pytest.mark.parametrize("bad", [nan, inf, -inf, 1.0001e12, -1.0001e12])
@pytest.mark.parametrize("cls", KINDS, ids=lambda cls: cls.__name__)
def test_a_number_that_is_not_finite_or_out_of_bounds_is_refused_wherever_it_stands(
    cls: type[Message], bad: float
) -> None:
    """Every float of every kind, also inside tuples, is replaced by a bad one, one at a time."""
    plain = [sample_of(field.type) for field in inspect.type_info(cls).fields]
    assert CODEC.decode(framed(KINDS.index(cls), msgspec.msgpack.encode(plain))) == cls(*plain)
    for spoilt in spoil(plain, bad):
        frame = framed(KINDS.index(cls), msgspec.msgpack.encode(spoilt))
        assert isinstance(CODEC.decode(frame), Refusal), spoilt


def sample_of(kind: inspect.Type) -> object:
    """A value of a field's type in which every float that can be there is there."""
    match kind:
        case inspect.VarTupleType(item_type=item):
            return (sample_of(item), sample_of(item))
        case inspect.TupleType(item_types=items):
            return tuple(sample_of(item) for item in items)
        case inspect.UnionType(types=types):
            return sample_of(next(t for t in types if not isinstance(t, inspect.NoneType)))
        case inspect.DictType():
            return {"sent": 1}
    plain = {inspect.BoolType: True, inspect.IntType: 3, inspect.FloatType: 0.5, inspect.StrType: "a"}
    return plain.get(type(kind), b"a")


def spoil(values: object, bad: float):
    """Copies of `values`, each with one float replaced by `bad`."""
    if isinstance(values, float):
        yield bad
    elif isinstance(values, (list, tuple)):
        for k, value in enumerate(values):
            for spoilt in spoil(value, bad):
                yield [*values[:k], spoilt, *values[k + 1 :]]


def test_a_tuple_that_is_absurdly_long_is_refused() -> None:
    longest = msgspec.structs.replace(READING, hears=((0, 1),) * MAX_RECORDS)
    assert CODEC.decode(CODEC.encode(longest)) == longest
    longer = msgspec.structs.replace(READING, hears=((0, 1),) * (MAX_RECORDS + 1))
    assert isinstance(CODEC.decode(CODEC.encode(longer)), Refusal)


def test_a_frame_that_is_too_large_is_refused() -> None:
    room = MAX_FRAME - len(CODEC.encode(Field(0, 0.0, b"", b""))) - 8
    assert isinstance(CODEC.decode(CODEC.encode(Field(0, 0.0, bytes(room), b""))), Field)
    assert isinstance(CODEC.decode(CODEC.encode(Field(0, 0.0, bytes(room + 100), b""))), Refusal)


def test_a_body_nested_without_end_is_refused() -> None:
    for depth in (100, 10_000, 900_000):
        assert isinstance(CODEC.decode(framed(KINDS.index(Drive), b"\x91" * depth + b"\xc0")), Refusal)


def test_a_body_with_fields_missing_or_of_another_kind_is_refused() -> None:
    drive = KINDS.index(Drive)
    assert isinstance(CODEC.decode(framed(drive, msgspec.msgpack.encode([1, 2, 0.5, 0.5]))), Drive)
    for body in ([1, 2, 0.5], [1, 2, 0.5, "half"], [1.5, 2, 0.5, 0.5], {"robot": 1}, None, "drive", []):
        assert isinstance(CODEC.decode(framed(drive, msgspec.msgpack.encode(body))), Refusal)


def test_an_unknown_version_or_kind_is_refused() -> None:
    body = msgspec.msgpack.encode(READING)
    for prefix in (b"Os\x02\x00", b"Os\x00\x00", b"os\x01\x00", b"Os\x01" + bytes((len(KINDS),)), b"Os\x01\xff"):
        check = zlib.crc32(prefix + TOKEN.to_bytes(8, "little") + body)
        refusal = CODEC.decode(prefix + check.to_bytes(4, "little") + body)
        assert isinstance(refusal, Refusal)
        assert "version" in refusal.reason


def test_the_bytes_of_schema_version_1_stay_what_they_are() -> None:
    """Who changes these changes SCHEMA_VERSION; a new kind at the end changes nothing for those that do not know it."""
    assert CODEC.encode(Drive(3, 7, 0.25, -0.5)).hex() == "4f7301022cad79ee950307cb3fd0000000000000cbbfe0000000000000c0"
    assert CODEC.encode(Answer(True, "µ")).hex() == "4f73010d9879591e92c3a2c2b5"
    names = "Reading Shared Drive Report Halt Belief Truth Field Event Progress Outcome Ask Join Answer Resume Linked Inject"
    names += " BeliefMap Stopped"
    assert " ".join(cls.__name__ for cls in KINDS) == names


def test_a_refusal_says_why_but_repeats_nothing_of_the_frame() -> None:
    frame = framed(KINDS.index(Answer), msgspec.msgpack.encode([True, 5, "secret"]))
    refusal = CODEC.decode(frame)
    assert isinstance(refusal, Refusal)
    assert "Answer" in refusal.reason
    assert "secret" not in refusal.reason


def test_kinds_are_told_apart_although_their_bodies_could_be_alike() -> None:
    """Outcome and Shared are both arrays; the kind in the header is under the check sum."""
    frame = bytearray(CODEC.encode(READING))
    for kind in range(len(KINDS)):
        if kind != KINDS.index(Reading):
            frame[3] = kind
            assert isinstance(CODEC.decode(bytes(frame)), Refusal)
    assert {Shared, Outcome} <= set(KINDS)
