"""What a case file may say, table by table, and loads as plain records.

Hands on the models that ``alula.loads.case`` puts together, and the load records of statics.
"""
