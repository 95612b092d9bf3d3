"""A laboratory file to fill in: every key, what may be left out commented out, and not one value made up."""

from __future__ import annotations

TEMPLATE = """\
# What a certificate says beyond the numbers. Fill in every "" and every date; a certificate is refused until then.
# Lines that begin with a # may be left out. Nothing that is left out is made up: the certificate says so.
format = "ulna-lab/1"

# ISO 639-1, the main language first. With several, a text may be a table: { en = "…", de = "…" }.
languages = ["en"]
# remarks = [""]

[certificate]
identifier = ""                # unique, given by the laboratory
country = ""                   # where it is issued: ISO 3166-1, such as "DE"
begin = ""                     # first day of the calibration: a date without quotes, such as 2026-03-30
end = ""                       # last day
location = "laboratory"        # or customer, laboratoryBranch, customerBranch, other
# issued = 2026-03-31
# received = 2026-03-27
# order = ""
# replaces = { identifier = "", change = "amended" }    # or substituted

[laboratory]
name = ""
address = { street = "", postcode = "", city = "", country = "" }
# email = ""
# phone = ""
# web = "https://"
# code = ""                    # the laboratory's code
# accreditation = { body = "", number = "", standard = "ISO/IEC 17025:2017" }
# logo = "logo.svg"            # for the letterhead of a printed certificate

[[person]]                     # one table for everybody who answers for the certificate
name = ""
role = ""
main_signer = true             # of exactly one person
# email = ""
# phone = ""

[customer]
name = ""
address = { street = "", postcode = "", city = "", country = "" }
# email = ""
# phone = ""
# web = "https://"

[item]
name = "Articulated arm coordinate measuring machine"
manufacturer = ""
model = ""
serial = ""
# description = ""
# condition = ""               # on receipt: "no damage visible", say
# scanner = ""                 # what the arm carries beside its probe: it is said that it was not tested
# identifications = [{ issuer = "customer", value = "", name = "Inventory number" }]

[environment]
# value and u (standard uncertainty), or low and high; unit "°C" or "K"
temperature = { value = "", u = "", unit = "°C" }
# humidity = { low = 40, high = 60, unit = "%" }
# remark = ""

# [[equipment]]                # one table for each standard: the ball bar, the sphere, the gauge block
# name = ""
# serial = ""
# manufacturer = ""
# model = ""
# certificate = ""             # identifier of its own calibration certificate
# certified_by = ""
# artefacts = ["bar"]          # what it is called in the study and in the verify file

# [traceability]
# statement = ""

# [cmc]                        # what an accredited laboratory may state at the least: no U of a test is below it
# unit = "mm"
# figure = { P_Size = 0.0010, E_Uni = { a = 0.0020, b = 500000 } }    # U, or a + L / b

# [[method]]                   # procedures that the laboratory followed; Ulna adds how it fitted
# name = ""
# description = ""
# norms = ["ISO 10360-12:2016"]
# references = [""]
"""
