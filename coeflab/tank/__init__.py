"""The virtual tow tank: from a body to a campaign of its forces.

Test matrix -> cases -> jobs -> runs that resume -> collected tables.
"""
