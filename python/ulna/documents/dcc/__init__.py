"""A digital calibration certificate: XML after PTB's schema DCC 3.3.0 with D-SI 2.2.1, an unsigned draft."""
