"""Entities of the standard include that a file may set: gravity and units, in the data sets of sys_misc.

Names: the page of *SetOption has them all in model.sys_misc; the page on implicit entities has DS_Gravity and
DS_Units at the model. Values: those of two exported decks whose models set none.
"""

from __future__ import annotations

from mdlgen.backends.motionview.reader.program import Program, program
from mdlgen.backends.motionview.reader.report import Notes
from mdlgen.backends.motionview.reader.scanner import statements
from mdlgen.backends.motionview.reader.source import Source

HOLDER = "sys_misc"
PREFIX = f"{HOLDER}.ds_"
FILE = "std_inc.mdl"
AT_MODEL = ("ds_gravity", "ds_units")
"""Data sets of it that have a name at the model, too: DS_Gravity, DS_Units."""

_TEXT = """
*System( sys_misc, "Misc", standard_sys_misc )
*DefineSystem( standard_sys_misc )
*DataSet( ds_gravity, "Gravity", standard_ds_gravity )
*DataSet( ds_units, "Units", standard_ds_units )
*SetReal( ds_gravity.kgrav, -9810 )
*EndDefine()
*DefineDataSet( standard_ds_gravity )
*Option( op_gravity, "Gravity", 2, "On", "Off", 1, 2, "On", "Off", EDIT )
*Real( igrav, "X", EDIT )
*Real( jgrav, "Y", EDIT )
*Real( kgrav, "Z", EDIT )
*EndDefine()
*DefineDataSet( standard_ds_units )
*StandardOption( op_force, "Force", "NEWTON", EDIT )
*StandardOption( op_length, "Length", "MILLIMETER", EDIT )
*StandardOption( op_mass, "Mass", "KILOGRAM", EDIT )
*StandardOption( op_time, "Time", "SECOND", EDIT )
*EndDefine()
"""


def standard() -> Program:
    """The definitions, and the statement that makes the system."""
    return program(statements(Source(_TEXT, FILE), Notes(), part=True), Notes())
